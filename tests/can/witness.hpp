#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/can/socketcan_bus.hpp"

namespace lodestar {

/// Hears everything on an interface, whoever says it, with the kernel's stamps.
class Witness {
 public:
  explicit Witness(const std::string& interface);
  ~Witness();
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  using Question = std::function<bool(const CanFrame&)>;

  /// The first frame after `since` that answers the question; waits for it, but not for longer than that.
  std::optional<StampedCanFrame> wait_for(const Question& question, Stamp since, Duration longest) const;

  /// All frames within (since, until] that answer the question.
  [[nodiscard]] std::vector<StampedCanFrame> heard(const Question& question, Stamp since,
                                                   Stamp until = Stamp::max()) const;

  /// The newest frame that answers the question, until then.
  [[nodiscard]] std::optional<Stamp> last(const Question& question, Stamp until = Stamp::max()) const;

  /// When the controller last said that something is wrong with the bus.
  [[nodiscard]] std::optional<Stamp> last_error() const;

 private:
  void listen();

  SocketCanBus bus_;
  mutable std::mutex mutex_;
  std::vector<StampedCanFrame> frames_;
  std::uint64_t errors_ = 0;
  std::optional<Stamp> last_error_;
  std::jthread thread_;
};

// Questions.
bool is_anything(const CanFrame& frame);
bool is_motion_command(const CanFrame& frame);
bool is_zero_command(const CanFrame& frame);
bool is_moving_command(const CanFrame& frame);
/// The base says that it drives faster than this.
Witness::Question drives_faster_than(double forward_mps);
bool says_standing(const CanFrame& frame);

}  // namespace lodestar
