#include "app/navigation/planning_context.hpp"

#include <array>
#include <utility>

#include "control/corner.hpp"

namespace lodestar {
namespace {

constexpr std::array usual_margins_m{0.10, 0.06, 0.03, 0.02, 0.01};
constexpr std::array wide_margins_m{0.25, 0.18, 0.12, 0.10, 0.06, 0.03, 0.02, 0.01};

}  // namespace

std::span<const double> margins_m(Margins margins) {
  return margins == Margins::wide ? std::span<const double>(wide_margins_m) : usual_margins_m;
}

PlanningContext::PlanningContext(std::shared_ptr<const ObstacleField> known,
                                 const GridPlannerOptions& options, Margins margins)
    : field(std::move(known)), planner(field, options, margins_m(margins)) {}

DriveOptions PlanningContext::drive_options(const Path& path, DriveOptions options) const {
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

}  // namespace lodestar
