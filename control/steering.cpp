#include "control/steering.hpp"

#include <algorithm>

namespace lodestar {

bool may_be_steered(const std::optional<StopReason>& stop) {
  return !stop || (*stop != StopReason::base_silent && !is_latched(*stop));
}

BodyVelocity within(const BodyVelocity& wanted, const SpeedLimit& limit, const SteeringOptions& options) {
  const double ahead_mps = std::min(options.max_forward_mps, std::max(0.0, limit.forward_mps));
  const double back_mps = std::min(options.max_backward_mps, std::max(0.0, limit.backward_mps));
  const double turn_radps = std::min(options.max_turn_radps, std::max(0.0, limit.turn_radps));
  return {std::clamp(wanted.forward_mps, -back_mps, ahead_mps),
          std::clamp(wanted.turn_radps, -turn_radps, turn_radps)};
}

}  // namespace lodestar
