#include "app/placement/visibility.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "app/navigation/navigation_setup.hpp"
#include "app/placement/marker_index.hpp"
#include "localization/pose/map_estimate.hpp"
#include "localization/pose/mount.hpp"
#include "maps/distance_field.hpp"
#include "maps/marker.hpp"
#include "maps/percentile.hpp"

namespace lodestar {
namespace {

double highest_m(const MarkerRegistry& registry) {
  double highest_m = 0.0;
  for (const RegisteredMarker& marker : registry.markers)
    highest_m = std::max(highest_m, map_from_marker(registry, marker).translation().z());
  return highest_m;
}

class Viewer {
 public:
  Viewer(const MarkerRegistry& registry, const CameraModel& camera, const SightLines* sight_lines,
         const VisibilityOptions& options)
      : markers_(registry, sight_reach_m(camera, options.base_from_camera, highest_m(registry))),
        camera_(camera),
        sight_lines_(sight_lines),
        options_(options) {}

  [[nodiscard]] CellView view_from(const Vec2& position_m) const {
    CellView view{.least = std::numeric_limits<int>::max(),
                  .most = 0,
                  .position_sigma_m = 0.0,
                  .heading_sigma_rad = 0.0};
    const std::vector<const MarkerInMap*> markers = markers_.about(position_m);
    for (int i = 0; i < options_.headings; ++i) {
      const double heading_rad = 2.0 * std::numbers::pi * i / options_.headings;
      add_heading({position_m, wrap_angle(heading_rad)}, markers, view);
    }
    return view;
  }

 private:
  void add_heading(const Pose2& map_from_base, const std::vector<const MarkerInMap*>& markers,
                   CellView& view) const {
    const Eigen::Isometry3d map_from_camera = lifted(map_from_base) * options_.base_from_camera;
    int seen = 0;
    std::vector<SurveyedDot> dots;
    for (const MarkerInMap* marker : markers)
      if (add_marker(*marker, map_from_camera, dots)) ++seen;
    view.least = std::min(view.least, seen);
    view.most = std::max(view.most, seen);
    const std::optional<PlanarFix> fix = expected_fix(map_from_camera, dots);
    if (!fix) {
      view.position_sigma_m.reset();
      view.heading_sigma_rad.reset();
    }
    if (!view.position_sigma_m) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(fix->covariance.topLeftCorner<2, 2>(),
                                                                Eigen::EigenvaluesOnly);
    view.position_sigma_m = std::max(*view.position_sigma_m, std::sqrt(solver.eigenvalues()[1]));
    view.heading_sigma_rad = std::max(*view.heading_sigma_rad, std::sqrt(fix->covariance(2, 2)));
  }

  /// Adds the marker's dots with their pixels; none when any of them is not visible.
  bool add_marker(const MarkerInMap& marker, const Eigen::Isometry3d& map_from_camera,
                  std::vector<SurveyedDot>& dots) const {
    const std::size_t before = dots.size();
    const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
    for (const Vec3& dot : marker.dots) {
      const std::optional<Vec2> pixel = camera_.project(camera_from_map * dot);
      if (!pixel || !camera_.contains(*pixel, options_.border_px)) {
        dots.resize(before);
        return false;
      }
      dots.push_back({dot, *pixel, options_.fix.dot_sigma_px});
    }
    if (sight_lines_ == nullptr || sight_lines_->is_clear(map_from_camera.translation(), marker.middle))
      return true;
    dots.resize(before);
    return false;
  }

  /// The fix that such dots would give, with the covariance of the pose estimate.
  [[nodiscard]] std::optional<PlanarFix> expected_fix(const Eigen::Isometry3d& map_from_camera,
                                                      const std::vector<SurveyedDot>& dots) const {
    if (dots.empty()) return std::nullopt;
    const std::optional<MapEstimate> estimate =
        maximize_posterior(map_from_camera, dots, camera_, options_.fix);
    if (!estimate) return std::nullopt;
    PoseFix fix;
    fix.map_from_camera = estimate->map_from_camera;
    fix.covariance = estimate->covariance;
    return compensate_mount(fix, options_.base_from_camera);
  }

  MarkerIndex markers_;
  const CameraModel& camera_;
  const SightLines* sight_lines_;
  VisibilityOptions options_;
};

/// For each cell the path length in metres over neighbouring cells to the nearest one that sees a marker at
/// every heading (Dijkstra 1959, from all of these at once); infinity where there is none.
std::vector<double> ways_to_a_view_m(const Visibility& visibility) {
  const OccupancyMap& map = visibility.map;
  std::vector<double> ways(map.cells.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (visibility.cells[i] && visibility.cells[i]->least > 0) open.emplace(ways[i] = 0.0, i);
  }
  while (!open.empty()) {
    const auto [way_m, index] = open.top();
    open.pop();
    if (way_m > ways[index]) continue;
    const auto columns = static_cast<std::size_t>(map.columns);
    const Cell from{static_cast<int>(index % columns), static_cast<int>(index / columns)};
    for (int step = 0; step < 9; ++step) {
      const Cell to{from.column + step % 3 - 1, from.row + step / 3 - 1};
      if (!map.contains(to) || !visibility.cells[map.index(to)]) continue;
      const double to_m = way_m + map.resolution_m * std::hypot(to.column - from.column, to.row - from.row);
      if (to_m >= ways[map.index(to)]) continue;
      open.emplace(ways[map.index(to)] = to_m, map.index(to));
    }
  }
  return ways;
}

}  // namespace

VisibilityOptions visibility_options(const Robot& robot) {
  VisibilityOptions options;
  options.base_from_camera = robot.base_from_camera;
  options.robot_radius_m = robot.radius_m;
  options.fix.prior = pose_prior(robot);
  return options;
}

Cell VisibilityOptions::cell_in_stride(const OccupancyMap& on, Cell corner) const {
  return {std::min(corner.column + stride / 2, on.columns - 1),
          std::min(corner.row + stride / 2, on.rows - 1)};
}

Visibility visibility_of(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                         const SightLines* sight_lines, const VisibilityOptions& options) {
  const Viewer viewer(registry, camera, sight_lines, options);
  const DistanceField distances(map);
  Visibility visibility{.map = map, .cells = std::vector<std::optional<CellView>>(map.cells.size())};
  for (int row = 0; row < map.rows; row += options.stride) {
    for (int column = 0; column < map.columns; column += options.stride) {
      if (options.cancelled.stop_requested()) return visibility;
      const Cell cell = options.cell_in_stride(map, {column, row});
      if (!is_drivable(map.at(cell)) || distances.distance_m(cell) <= options.robot_radius_m) continue;
      visibility.cells[map.index(cell)] = viewer.view_from(map.center_of(cell));
    }
  }
  return visibility;
}

VisibilitySummary summarize(const Visibility& visibility) {
  VisibilitySummary summary;
  const std::vector<double> ways_m = ways_to_a_view_m(visibility);
  std::vector<double> position_sigmas_m;
  std::vector<double> heading_sigmas_rad;
  std::size_t one = 0;
  std::size_t two = 0;
  std::size_t some = 0;
  for (std::size_t i = 0; i < visibility.cells.size(); ++i) {
    const std::optional<CellView>& cell = visibility.cells[i];
    if (!cell) continue;
    ++summary.cells;
    one += cell->least >= 1 ? 1 : 0;
    two += cell->least >= 2 ? 1 : 0;
    some += cell->most >= 1 ? 1 : 0;
    if (cell->position_sigma_m) position_sigmas_m.push_back(*cell->position_sigma_m);
    if (cell->heading_sigma_rad) heading_sigmas_rad.push_back(*cell->heading_sigma_rad);
    if (std::isinf(ways_m[i])) {
      ++summary.cells_cut_off;
    } else if (ways_m[i] > summary.largest_gap_m) {
      summary.largest_gap_m = ways_m[i];
      const auto columns = static_cast<std::size_t>(visibility.map.columns);
      summary.gap_at_m =
          visibility.map.center_of({static_cast<int>(i % columns), static_cast<int>(i / columns)});
    }
  }
  const auto share = [&](std::size_t count) {
    return summary.cells == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(summary.cells);
  };
  summary.share_one = share(one);
  summary.share_two = share(two);
  summary.share_some_heading = share(some);
  summary.position_sigma_p50_m = percentile(position_sigmas_m, 0.5);
  summary.position_sigma_p95_m = percentile(std::move(position_sigmas_m), 0.95);
  summary.heading_sigma_p95_rad = percentile(std::move(heading_sigmas_rad), 0.95);
  return summary;
}

}  // namespace lodestar
