#include "app/console/survey.hpp"

#include <algorithm>
#include <cmath>

#include "app/navigation_setup.hpp"
#include "app/visibility.hpp"
#include "maps/marker.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

/// How far from its axis the camera sees on all sides, per metre of height: what it covers however the robot
/// has turned.
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

/// So high may markers hang, for all that is known.
double ceiling_m(const Site& site) {
  constexpr double usual_m = 3.0;
  constexpr double more_m = 0.5;
  double highest_m = usual_m;
  for (const RegisteredMarker& marker : site.registry.markers)
    highest_m = std::max(highest_m, marker.position_m.z());
  return highest_m + more_m;
}

}  // namespace

ordered_json usual_routes(const Site& site) {
  const MarginPlanner planner(site.map.map, navigation_options(site.robot).planner);
  ordered_json routes = ordered_json::array();
  Vec2 from_m = site.start.position_m;
  for (const Goal& goal : site.goals) {
    const PlanResult result = planner.plan(from_m, goal.position_m, {});
    from_m = goal.position_m;
    const auto* plan = std::get_if<Plan>(&result);
    if (plan == nullptr) continue;
    ordered_json route = ordered_json::array();
    for (const Vec2& at : plan->path.waypoints_m) route.push_back({at.x(), at.y()});
    routes.push_back(route);
  }
  return routes;
}

nlohmann::ordered_json coverage_json(const Site& site) {
  const Vec3 camera = site.robot.base_from_camera.translation();
  const double half_marker_m =
      0.5 * (marker_grid_size - 1) * marker_pitch_m * std::sqrt(2.0) + marker_dot_radius_m;
  return {{"camera", site.default_camera},
          {"camera_height_m", camera.z()},
          {"reach_per_m", narrowest_view(site.cameras.at(site.default_camera))},
          {"margin_m", half_marker_m + camera.head<2>().norm()}};
}

SiteView::SiteView(const Site& site) {
  if (!site.octomap_file) return;
  sight_lines_.emplace(*site.octomap_file);
  const double camera_m = site.robot.base_from_camera.translation().z();
  heights_ = height_bands(*site.octomap_file, site.map.map, camera_m, ceiling_m(site));
}

ordered_json SiteView::deviations(const Site& site, const MarkerRegistry& registry) const {
  constexpr double apart_m = 0.25;
  constexpr double mm_per_m = 1000.0;
  const OccupancyMap& map = site.map.map;
  VisibilityOptions options{.base_from_camera = site.robot.base_from_camera,
                            .robot_radius_m = site.robot.radius_m};
  options.fix.prior = pose_prior(site.robot);
  options.stride = std::max(1, static_cast<int>(std::lround(apart_m / map.resolution_m)));
  const Visibility seen = visibility_of(map, registry, site.cameras.at(site.default_camera),
                                        sight_lines_ ? &*sight_lines_ : nullptr, options);
  ordered_json sigmas = ordered_json::array();
  for (int row = 0; row < map.rows; row += options.stride) {
    for (int column = 0; column < map.columns; column += options.stride) {
      const Cell middle = options.cell_in_stride(map, {column, row});
      const std::optional<CellView>& cell = seen.cells[map.index(middle)];
      const bool is_known = cell && cell->position_sigma_m;
      sigmas.push_back(is_known ? ordered_json(std::round(1e3 * mm_per_m * *cell->position_sigma_m) / 1e3)
                                : ordered_json(nullptr));
    }
  }
  return {{"stride", options.stride},
          {"columns", (map.columns + options.stride - 1) / options.stride},
          {"sigma_mm", sigmas}};
}

}  // namespace lodestar
