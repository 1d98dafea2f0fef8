#pragma once

#include <optional>

#include "maps/motion.hpp"

namespace lodestar {

/// How fast a robot that turns on the spot and then drives straight can do either.
struct MotionLimits {
  double max_forward_mps = 0.6;
  double max_turn_radps = 1.2;
  double max_acceleration_mps2 = 0.5;
  double max_turn_acceleration_radps2 = 2.0;

  /// From rest to rest, with the time-optimal trapezoid of speed (a triangle when short).
  [[nodiscard]] double leg_time_s(double length_m) const;
  [[nodiscard]] double turn_time_s(double angle_rad) const;  ///< of either sign
};

/// The time a perfect robot takes for the path: at every waypoint at rest, turning on the spot, then straight
/// to the next. Turns to and from the given headings are added where there are such.
double travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                     std::optional<double> final_heading_rad, const MotionLimits& limits);

}  // namespace lodestar
