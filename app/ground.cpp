#include "app/ground.hpp"

#include <array>

#include "control/corner.hpp"

namespace lodestar {
namespace {

/// Where there is room, a path keeps away from everything, so that a robot which must go some way without a
/// marker may be unsure of its place.
constexpr std::array margins_m{0.10, 0.06, 0.03, 0.02, 0.01};
constexpr std::array margins_when_lost_m{0.12, 0.10, 0.06, 0.03, 0.02, 0.01};

}  // namespace

Ground::Ground(const OccupancyMap& known, const GridPlannerOptions& options)
    : map(known), planner(map, options, margins_m), free_way(map, options.radius_m) {}

DriveOptions Ground::drive_options(const Path& path, DriveOptions options) const {
  for (std::size_t i = 2; i < path.waypoints_m.size(); ++i) {
    const Vec2& waypoint = path.waypoints_m[i - 1];
    const auto corner = corner_at(path.waypoints_m[i - 2], waypoint, path.waypoints_m[i], options);
    if (!corner) continue;
    const Vec2 begin = waypoint + corner->cut_m * (path.waypoints_m[i - 2] - waypoint).normalized();
    const Vec2 end = waypoint + corner->cut_m * (path.waypoints_m[i] - waypoint).normalized();
    if (!planner.is_roomy(begin, end)) options.blend_corridor_m = 0.0;
  }
  return options;
}

PlanResult plan_for_a_lost_robot(const OccupancyMap& map, const GridPlannerOptions& options,
                                 const Vec2& start_m, const Vec2& goal_m) {
  return MarginPlanner(map, options, margins_when_lost_m).plan(start_m, goal_m);
}

}  // namespace lodestar
