#include "control/differential_drive.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

WheelSpeeds wheel_speeds(const BodyVelocity& velocity, double track_width_m) {
  const double difference = 0.5 * track_width_m * velocity.turn_radps;
  return {velocity.forward_mps - difference, velocity.forward_mps + difference};
}

BodyVelocity body_velocity(const WheelSpeeds& speeds, double track_width_m) {
  return {0.5 * (speeds.left_mps + speeds.right_mps), (speeds.right_mps - speeds.left_mps) / track_width_m};
}

double turned_rad(const WheelTravel& travel, double track_width_m) {
  return (travel.right_m - travel.left_m) / track_width_m;
}

BodyVelocity within_wheel_limit(const BodyVelocity& velocity, double track_width_m, double max_wheel_mps) {
  const WheelSpeeds speeds = wheel_speeds(velocity, track_width_m);
  const double fastest = std::max(std::abs(speeds.left_mps), std::abs(speeds.right_mps));
  if (fastest <= max_wheel_mps) return velocity;
  const double scale = max_wheel_mps / fastest;
  return {scale * velocity.forward_mps, scale * velocity.turn_radps};
}

}  // namespace lodestar
