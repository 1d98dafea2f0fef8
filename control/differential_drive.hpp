#pragma once

#include "maps/motion.hpp"

namespace lodestar {

struct WheelSpeeds {
  double left_mps = 0.0;
  double right_mps = 0.0;
};

WheelSpeeds wheel_speeds(const BodyVelocity& velocity, double track_width_m);
BodyVelocity body_velocity(const WheelSpeeds& speeds, double track_width_m);

/// How far the wheels say that the robot has turned since they were at zero, up to a factor near 1.
double turned_rad(const WheelTravel& travel, double track_width_m);

/// The velocity scaled down, if need be, so that no wheel exceeds the limit; the curve's radius is kept.
BodyVelocity within_wheel_limit(const BodyVelocity& velocity, double track_width_m, double max_wheel_mps);

}  // namespace lodestar
