#pragma once

#include "maps/geometry.hpp"

namespace lodestar {

/// Drive parameters of a robot, from robot.yaml.
struct DriveOptions {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;
  double max_wheel_mps = 0.8;
  double track_width_m = 0.4;
  double min_forward_mps = 0.02;              ///< dead band: below it the motors stand still
  double min_turn_radps = 0.06;               ///< likewise
  double response_s = 0.12;                   ///< from a command to its effect: lag and latency of the base
  double arrival_distance_m = 0.01;           ///< goal tolerance, epsilon of Eq. (19)
  double arrival_heading_rad = radians(1.0);  ///< tolerance of the final heading, when one is set
  /// Waypoints are passed without stopping, on an arc within this distance of the legs. 0: the robot stops
  /// and turns at each. The path needs this much more clearance at its corners.
  double blend_corridor_m = 0.0;
};

/// Share of the greatest deceleration that braking is planned with. Chosen by hand: the other fifth covers a
/// base that responds late or weakly.
inline constexpr double braking_share = 0.8;

}  // namespace lodestar
