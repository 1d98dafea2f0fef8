#pragma once

#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

/// Limits of a robot that turns on the spot and drives straight.
struct MotionLimits {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;

  /// From rest to rest, with the time-optimal trapezoidal speed profile (triangular for short distances).
  [[nodiscard]] double leg_time_s(double length_m) const;
  [[nodiscard]] double turn_time_s(double angle_rad) const;  ///< of either sign
};

/// Ideal time for the path: rest at every waypoint, turn on the spot, then drive straight to the next. Turns
/// from the start heading and to the goal heading are added where given.
double travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                     std::optional<double> final_heading_rad, const MotionLimits& limits);

}  // namespace lodestar
