#pragma once

#include "maps/geometry.hpp"

namespace lodestar {

/// What differs from robot to robot: robot.yaml says it.
struct DriveOptions {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;
  double max_wheel_mps = 0.8;
  double track_width_m = 0.4;
  double min_forward_mps = 0.02;              ///< dead band: slower, the motors stand still
  double min_turn_radps = 0.06;               ///< likewise
  double response_s = 0.12;                   ///< from a command to its effect: lag and latency of the base
  double arrival_distance_m = 0.01;           ///< epsilon of Eq. (19), at the goal
  double arrival_heading_rad = radians(1.0);  ///< of the final heading, when one is wanted
  /// A waypoint may be passed on an arc, without stopping, that stays this near to the legs. 0: the robot
  /// stops and turns at each. The path must be clear by so much more at its corners.
  double blend_corridor_m = 0.0;
};

/// Of the greatest deceleration, that braking is planned with. Chosen by hand: the fifth that is left is for
/// what the base does late or less than told.
inline constexpr double braking_share = 0.8;

}  // namespace lodestar
