#include "app/placement/site_floor.hpp"

#include <algorithm>
#include <cmath>

#include "app/navigation/navigation_setup.hpp"
#include "maps/marker.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

/// Radius per metre of height that the camera sees around its axis on all sides, and so covers at every
/// heading.
double narrowest_view(const CameraModel& camera) {
  double narrowest = 1e9;
  const double right = camera.width_px - 1.0;
  const double bottom = camera.height_px - 1.0;
  for (const Vec2& side : {Vec2(0.0, camera.cy_px), Vec2(right, camera.cy_px), Vec2(camera.cx_px, 0.0),
                           Vec2(camera.cx_px, bottom)}) {
    if (const std::optional<Vec2> ray = camera.normalized(side)) narrowest = std::min(narrowest, ray->norm());
  }
  return narrowest;
}

AllHeadingsView all_headings_view(const Site& site) {
  const Vec3 camera = site.robot.base_from_camera.translation();
  const double half_marker_m =
      0.5 * (marker_grid_size - 1) * marker_pitch_m * std::sqrt(2.0) + marker_dot_radius_m;
  return {.camera_height_m = camera.z(),
          .reach_per_m = narrowest_view(site.cameras.at(site.default_camera)),
          .margin_m = half_marker_m + camera.head<2>().norm()};
}

std::vector<Path> usual_routes(const Site& site) {
  const MarginPlanner planner(drivable_map(site), navigation_options(site.robot).planner);
  std::vector<Path> routes;
  Vec2 from_m = site.start.position_m;
  for (const Goal& goal : site.goals) {
    const PlanResult result = planner.plan(from_m, goal.position_m, {});
    from_m = goal.position_m;
    if (const auto* plan = std::get_if<Plan>(&result)) routes.push_back(plan->path);
  }
  return routes;
}

/// Upper bound of the marker height: 0.5 m above the highest registered marker, or above 3 m.
double ceiling_m(const Site& site) {
  constexpr double usual_m = 3.0;
  constexpr double more_m = 0.5;  // assumed, for a part of the ceiling that is higher
  double highest_m = usual_m;
  for (const RegisteredMarker& marker : site.registry.markers)
    highest_m = std::max(highest_m, marker.position_m.z());
  return highest_m + more_m;
}

}  // namespace

CoveredFloor covered_floor(const Site& site) {
  const Robot& robot = site.robot;
  CoveredFloor floor{.map = site.map.map,
                     .heights = std::nullopt,
                     .room_m = robot.footprint ? robot.footprint->inner_radius_m() : robot.radius_m,
                     .view = all_headings_view(site),
                     .routes = usual_routes(site)};
  if (site.octomap_file)
    floor.heights = height_bands(*site.octomap_file, floor.map, floor.view.camera_height_m, ceiling_m(site));
  return floor;
}

}  // namespace lodestar
