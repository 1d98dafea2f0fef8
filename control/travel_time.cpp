#include "control/travel_time.hpp"

#include <cmath>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

/// From rest to rest over a distance: a triangle of speed when it is too short to reach the limit, else a
/// trapezoid.
double trapezoid_time(double distance, double max_speed, double max_acceleration) {
  const double ramps = max_speed * max_speed / max_acceleration;
  return distance < ramps ? 2.0 * std::sqrt(distance / max_acceleration)
                          : distance / max_speed + max_speed / max_acceleration;
}

double turn_time_s(double from_rad, double to_rad, const DriveOptions& options) {
  const double max_turn_radps =
      std::min(options.max_turn_radps, 2.0 * options.max_wheel_mps / options.track_width_m);
  return trapezoid_time(std::abs(wrap_angle(to_rad - from_rad)), max_turn_radps,
                        options.max_turn_acceleration_radps2);
}

}  // namespace

double ideal_travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                           std::optional<double> final_heading_rad, const DriveOptions& options) {
  const double max_forward_mps = std::min(options.max_forward_mps, options.max_wheel_mps);
  double time_s = 0.0;
  std::optional<double> heading = start_heading_rad;
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i) {
    const Vec2 leg = path.waypoints_m[i] - path.waypoints_m[i - 1];
    if (leg.isZero()) continue;
    const double leg_heading = std::atan2(leg.y(), leg.x());
    if (heading) time_s += turn_time_s(*heading, leg_heading, options);
    time_s += trapezoid_time(leg.norm(), max_forward_mps, options.max_acceleration_mps2);
    heading = leg_heading;
  }
  if (heading && final_heading_rad) time_s += turn_time_s(*heading, *final_heading_rad, options);
  return time_s;
}

}  // namespace lodestar
