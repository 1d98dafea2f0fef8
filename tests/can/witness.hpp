#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/can/socketcan_bus.hpp"

namespace lodestar {

/// Receives every frame on an interface, from any sender, with the kernel's stamps.
class Witness {
 public:
  explicit Witness(const std::string& interface);
  ~Witness();
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  using Question = std::function<bool(const CanFrame&)>;

  /// The first frame after `since` that matches; waits for it for at most `longest`.
  std::optional<StampedCanFrame> wait_for(const Question& question, Stamp since, Duration longest) const;

  /// All matching frames within (since, until].
  [[nodiscard]] std::vector<StampedCanFrame> heard(const Question& question, Stamp since,
                                                   Stamp until = Stamp::max()) const;

  /// Stamp of the newest matching frame up to `until`.
  [[nodiscard]] std::optional<Stamp> last(const Question& question, Stamp until = Stamp::max()) const;

  /// Stamp of the controller's last error frame.
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

// Predicates.
bool is_anything(const CanFrame& frame);
bool is_motion_command(const CanFrame& frame);
bool is_zero_command(const CanFrame& frame);
bool is_moving_command(const CanFrame& frame);
/// The base reports a higher speed than this.
Witness::Question drives_faster_than(double forward_mps);
bool says_standing(const CanFrame& frame);

}  // namespace lodestar
