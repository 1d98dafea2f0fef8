#pragma once

#include <optional>

#include "control/safety_stop.hpp"
#include "control/speed_limit.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Driving by hand: a person who sees the robot answers for obstacles, so it is slow. At 0.3 m/s a lab robot
/// (0.5 m/s^2) stops within 0.1 m of the order's end, and a survey sees each marker in some dozens of frames.
struct SteeringOptions {
  double max_forward_mps = 0.3;
  double max_backward_mps = 0.15;
  double max_turn_radps = 0.5;
};

/// May the robot be steered in spite of this reason to stop? Of its pose and camera a person knows enough.
bool may_be_steered(const std::optional<StopReason>& stop);

/// The velocity within the limits; where the pose is known, also within what speed zones
/// allow and, ahead, within what the map leaves free.
BodyVelocity within(const BodyVelocity& wanted, const SpeedLimit& limit, const SteeringOptions& options);

}  // namespace lodestar
