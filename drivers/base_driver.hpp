#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/agilex_v2.hpp"
#include "drivers/can_bus.hpp"
#include "maps/motion.hpp"

namespace lodestar {

struct BaseDriverOptions {
  double max_forward_mps = 1.0;  ///< commands beyond are saturated, and counted
  double max_turn_radps = 2.0;
  Duration handshake_period =
      std::chrono::milliseconds(100);  ///< how often CAN mode is asked for until granted
  Duration max_feedback_age = std::chrono::milliseconds(100);
};

enum class BaseState { waiting_for_base, asking_for_can_mode, ready, fault };

/// What the base said since the last poll.
struct BaseFeedback {
  BaseState state = BaseState::waiting_for_base;
  std::vector<WheelTravel> travel;       ///< new odometer readings, oldest first, unwrapped
  std::optional<BodyVelocity> measured;  ///< the newest motion state
  std::optional<Stamp> last_heard;       ///< of the newest valid frame from the base
};

/// The navigator's side of an AgileX V2 base. It knows the base by CAN frames only.
class BaseDriver {
 public:
  explicit BaseDriver(CanBus& bus, const BaseDriverOptions& options = {});

  /// Takes in all frames that have arrived, and carries on the handshake.
  BaseFeedback poll(Stamp now);

  /// Sends one motion command, if the base is ready; otherwise sends nothing. A velocity that is not finite
  /// is sent as zero and counted as a fault.
  void command(const BodyVelocity& velocity);

  [[nodiscard]] std::uint64_t saturated_commands() const { return saturated_; }

 private:
  CanBus& bus_;
  BaseDriverOptions options_;
  std::uint64_t saturated_ = 0;
};

}  // namespace lodestar
