#pragma once

#include "maps/geometry.hpp"

namespace lodestar {

struct DriveOptions {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;
  double max_wheel_mps = 0.8;
  double track_width_m = 0.4;
  double min_forward_mps = 0.02;  ///< slower, real motors stand still
  double min_turn_radps = 0.06;   ///< likewise
  double response_s = 0.12;       ///< from a command to its effect: lag and latency of the base
  double braking_share = 0.8;     ///< of the acceleration, that braking at the end of a leg is planned with
  double arrival_distance_m = 0.01;           ///< epsilon of Eq. (19), at the goal
  double waypoint_distance_m = 0.02;          ///< epsilon at the waypoints between
  double arrival_heading_rad = radians(1.0);  ///< of the final heading, when one is wanted
  double turn_done_rad = radians(1.0);        ///< rotation before a leg ends here
  double turn_again_rad = radians(20.0);  ///< a leg's heading error from which the robot stops to rotate anew
  double heading_gain_per_s = 2.5;        ///< heading correction while driving
  double lateral_gain_per_m = 2.5;        ///< heading wanted towards the leg, per metre beside it
  double passed_distance_m = 0.015;       ///< not worth turning back to a goal passed this near
  int max_approaches = 4;  ///< tries at the goal's epsilon before coming this near counts as arrival
  /// A waypoint may be passed on an arc, without stopping, that stays this near to the legs. 0: the robot
  /// stops and turns at each. The path must be clear by so much more at its corners.
  double blend_corridor_m = 0.0;
  double max_blend_turn_rad = radians(60.0);  ///< at sharper corners it stops all the same
};

}  // namespace lodestar
