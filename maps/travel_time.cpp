#include "maps/travel_time.hpp"

namespace lodestar {

double travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                     std::optional<double> final_heading_rad, const MotionLimits& limits) {
  double time_s = 0.0;
  std::optional<double> heading = start_heading_rad;
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i) {
    const Vec2 leg = path.waypoints_m[i] - path.waypoints_m[i - 1];
    if (leg.isZero()) continue;
    const double leg_heading = heading_of(leg);
    if (heading) time_s += limits.turn_time_s(wrap_angle(leg_heading - *heading));
    time_s += limits.leg_time_s(leg.norm());
    heading = leg_heading;
  }
  if (heading && final_heading_rad) time_s += limits.turn_time_s(wrap_angle(*final_heading_rad - *heading));
  return time_s;
}

}  // namespace lodestar
