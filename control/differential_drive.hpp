#pragma once

#include "maps/motion.hpp"

namespace lodestar {

struct WheelSpeeds {
  double left_mps = 0.0;
  double right_mps = 0.0;
};

WheelSpeeds wheel_speeds(const BodyVelocity& velocity, double track_width_m);
BodyVelocity body_velocity(const WheelSpeeds& speeds, double track_width_m);

/// Rotation of the robot by wheel odometry since its zero, up to a scale error.
double turned_rad(const WheelTravel& travel, double track_width_m);

/// The velocity, scaled down where a wheel would exceed the limit; the curve's radius is kept.
BodyVelocity within_wheel_limit(const BodyVelocity& velocity, double track_width_m, double max_wheel_mps);

}  // namespace lodestar
