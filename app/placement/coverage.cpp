#include "app/placement/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "app/placement/plausibility.hpp"
#include "maps/distance_field.hpp"

namespace lodestar {
namespace {

constexpr double most_blind_m = 1.0;  ///< of a route to drive by odometry alone
constexpr double least_gap_m2 = 0.1;

/// Lines of sight between points given in cells from the grid's corner.
class Sight {
 public:
  explicit Sight(const CoveredFloor& floor)
      : floor_(floor), grid_from_map_(inverse(floor.map.map_from_grid)) {}

  [[nodiscard]] Vec2 in_cells(const Vec2& on_map) const {
    return (grid_from_map_ * on_map) / floor_.map.resolution_m;
  }

  [[nodiscard]] bool is_free(const Vec2& at, const Vec2& marker, double marker_z_m) const {
    return floor_.heights ? is_free_in_height(*floor_.heights, at, marker, marker_z_m)
                          : is_free_on_map(at, marker);
  }

 private:
  /// Occupied cells directly below the marker do not hide it: they do not reach the ceiling.
  [[nodiscard]] bool is_free_on_map(const Vec2& at, const Vec2& marker) const {
    const auto steps = static_cast<int>(std::ceil((at - marker).norm()));
    bool is_over = true;
    for (int i = 0; i < steps; ++i) {
      const Cell cell = cell_at(marker + (at - marker) * (static_cast<double>(i) / steps));
      if (!floor_.map.contains(cell)) return false;
      const bool is_occupied = floor_.map.at(cell) >= 50;
      if (is_occupied && !is_over) return false;
      is_over = is_over && is_occupied;
    }
    return true;
  }

  /// Cells within touch_m of the camera or of the marker, such as the ceiling, do not count as obstacles
  /// between them.
  [[nodiscard]] bool is_free_in_height(const HeightBands& heights, const Vec2& at, const Vec2& marker,
                                       double marker_z_m) const {
    const OccupancyMap& map = floor_.map;
    const double camera_z_m = floor_.view.camera_height_m;
    const double length_m = std::hypot(map.resolution_m * (at - marker).norm(), marker_z_m - camera_z_m);
    const auto steps =
        static_cast<int>(std::ceil(2.0 * length_m / std::min(map.resolution_m, heights.step_m)));
    for (int i = 1; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      if (std::min(t, 1.0 - t) * length_m <= heights.touch_m) continue;
      const Cell cell = cell_at(at + t * (marker - at));
      if (!map.contains(cell)) continue;
      const double z_m = camera_z_m + t * (marker_z_m - camera_z_m);
      const auto band = static_cast<int>(std::floor((z_m - heights.low_m) / heights.step_m));
      if (band < 0 || band >= HeightBands::count) continue;
      if ((heights.cells[map.index(cell)] >> static_cast<unsigned>(band) & 1U) != 0) return false;
    }
    return true;
  }

  const CoveredFloor& floor_;
  Pose2 grid_from_map_;
};

/// A marker's centre, in cells, and the radius in cells within which a robot sees it at every heading.
struct MarkerDisc {
  Vec2 middle = Vec2::Zero();
  double z_m = 0.0;
  double reach = 0.0;
};

std::vector<MarkerDisc> marker_discs(const MarkerRegistry& registry, const CoveredFloor& floor,
                                     const Sight& sight) {
  std::vector<MarkerDisc> all;
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec3 middle = center_in_map(registry, marker);
    all.push_back({sight.in_cells(middle.head<2>()), middle.z(),
                   floor.view.reach_m(middle.z()) / floor.map.resolution_m});
  }
  return all;
}

/// For each cell: true where the robot can be but sees no marker.
std::vector<bool> blind_cells(const MarkerRegistry& registry, const CoveredFloor& floor) {
  const OccupancyMap& map = floor.map;
  const DistanceField distances(map);
  const double room = floor.room_m / map.resolution_m;
  std::vector<bool> blind(map.cells.size());
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      blind[map.index({column, row})] = distances.squared_cells({column, row}) > room * room;

  const Sight sight(floor);
  for (const MarkerDisc& marker : marker_discs(registry, floor, sight)) {
    const Vec2 low = (marker.middle.array() - marker.reach).floor().max(0.0);
    const Vec2 high = marker.middle.array() + marker.reach;
    for (int row = static_cast<int>(low.y()); row < std::min<double>(map.rows, high.y()); ++row) {
      for (int column = static_cast<int>(low.x()); column < std::min<double>(map.columns, high.x());
           ++column) {
        const std::size_t index = map.index({column, row});
        const Vec2 at = center_of({column, row});
        if (!blind[index] || (at - marker.middle).squaredNorm() > marker.reach * marker.reach) continue;
        if (sight.is_free(at, marker.middle, marker.z_m)) blind[index] = false;
      }
    }
  }
  return blind;
}

/// The blind cells connected to this one (flood fill); clears them in `blind`.
std::vector<Cell> taken_from(std::vector<bool>& blind, const OccupancyMap& map, Cell first) {
  std::vector<Cell> cells{first};
  blind[map.index(first)] = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell cell = cells[i];
    for (const Cell next : {Cell{cell.column - 1, cell.row}, Cell{cell.column + 1, cell.row},
                            Cell{cell.column, cell.row - 1}, Cell{cell.column, cell.row + 1}}) {
      if (!map.contains(next) || !blind[map.index(next)]) continue;
      blind[map.index(next)] = false;
      cells.push_back(next);
    }
  }
  return cells;
}

/// Its places are the corners of its bounding box, for a view to zoom to.
RegistryIssue gap_issue(const OccupancyMap& map, const std::vector<Cell>& cells, double area_m2) {
  Vec2 low = Vec2::Constant(1e300);
  Vec2 high = -low;
  for (const Cell cell : cells) {
    low = low.cwiseMin(map.center_of(cell));
    high = high.cwiseMax(map.center_of(cell));
  }
  const Vec2 middle = 0.5 * (low + high);
  const auto off = [&](Cell cell) { return (map.center_of(cell) - middle).squaredNorm(); };
  const Vec2 at = map.center_of(*std::ranges::min_element(cells, {}, off));
  return {.kind = IssueKind::gap,
          .error = false,
          .ids = {},
          .line = 0,
          .words = fmt::format("{:.1f} m² near {:.1f}, {:.1f} m without any marker", area_m2, at.x(), at.y()),
          .places_m = {low, high}};
}

/// Is it the same stretch, in either direction?
bool is_same_stretch(const BlindStretch& a, const BlindStretch& b) {
  const auto near = [](const Vec2& p, const Vec2& q) { return (p - q).norm() < 0.3; };
  return (near(a.from_m, b.from_m) && near(a.to_m, b.to_m)) ||
         (near(a.from_m, b.to_m) && near(a.to_m, b.from_m));
}

/// Points along a route, at most 5 cm apart.
std::vector<Vec2> places_along(const Path& route) {
  constexpr double step_m = 0.05;
  std::vector<Vec2> places;
  for (std::size_t i = 0; i + 1 < route.waypoints_m.size(); ++i) {
    const Vec2& from = route.waypoints_m[i];
    const Vec2 leg = route.waypoints_m[i + 1] - from;
    const auto steps = std::max(1, static_cast<int>(std::ceil(leg.norm() / step_m)));
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) places.emplace_back(from + leg * k / steps);
  }
  return places;
}

std::vector<BlindStretch> blind_stretches(const Path& route, const Sight& sight,
                                          const std::vector<MarkerDisc>& markers) {
  std::vector<BlindStretch> stretches;
  bool was_blind = false;
  for (const Vec2& place : places_along(route)) {
    const Vec2 at = sight.in_cells(place);
    const bool is_blind = std::ranges::none_of(markers, [&](const MarkerDisc& marker) {
      return (at - marker.middle).norm() <= marker.reach && sight.is_free(at, marker.middle, marker.z_m);
    });
    if (is_blind && was_blind) {
      BlindStretch& stretch = stretches.back();
      stretch.length_m += (place - stretch.to_m).norm();
      stretch.to_m = place;
    } else if (is_blind) {
      stretches.push_back({place, place, 0.0});
    }
    was_blind = is_blind;
  }
  std::erase_if(stretches, [](const BlindStretch& stretch) { return stretch.length_m <= most_blind_m; });
  return stretches;
}

}  // namespace

double AllHeadingsView::reach_m(double marker_height_m) const {
  return std::max(0.0, (marker_height_m - camera_height_m) * reach_per_m - margin_m);
}

std::vector<RegistryIssue> find_gaps(const MarkerRegistry& registry, const CoveredFloor& floor) {
  const OccupancyMap& map = floor.map;
  std::vector<bool> blind = blind_cells(registry, floor);
  std::vector<std::pair<double, RegistryIssue>> gaps;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (!blind[map.index({column, row})]) continue;
      const std::vector<Cell> cells = taken_from(blind, map, {column, row});
      const double area_m2 = static_cast<double>(cells.size()) * map.resolution_m * map.resolution_m;
      if (area_m2 >= least_gap_m2) gaps.emplace_back(area_m2, gap_issue(map, cells, area_m2));
    }
  }
  std::ranges::stable_sort(gaps, std::ranges::greater(), &std::pair<double, RegistryIssue>::first);
  std::vector<RegistryIssue> issues;
  for (auto& [area_m2, gap] : gaps) issues.push_back(std::move(gap));
  return issues;
}

std::vector<BlindStretch> blind_stretches_of(const Path& way, const MarkerRegistry& registry,
                                             const CoveredFloor& floor) {
  const Sight sight(floor);
  return blind_stretches(way, sight, marker_discs(registry, floor, sight));
}

std::vector<RegistryIssue> find_blind_stretches(const MarkerRegistry& registry, const CoveredFloor& floor) {
  const Sight sight(floor);
  const std::vector<MarkerDisc> markers = marker_discs(registry, floor, sight);
  std::vector<BlindStretch> found;
  for (const Path& route : floor.routes) {
    for (const BlindStretch& stretch : blind_stretches(route, sight, markers)) {
      const auto is_same = [&](const BlindStretch& other) { return is_same_stretch(stretch, other); };
      if (std::ranges::none_of(found, is_same)) found.push_back(stretch);
    }
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &BlindStretch::length_m);
  std::vector<RegistryIssue> issues;
  for (const BlindStretch& stretch : found) {
    issues.push_back(
        {.kind = IssueKind::blind_route,
         .error = false,
         .ids = {},
         .line = 0,
         .words = fmt::format("the usual route sees no marker for {:.1f} m from {:.1f}, {:.1f} m",
                              stretch.length_m, stretch.from_m.x(), stretch.from_m.y()),
         .places_m = {stretch.from_m, stretch.to_m}});
  }
  return issues;
}

std::vector<RegistryIssue> check_coverage(const MarkerRegistry& registry, const CoveredFloor& floor,
                                          const std::stop_token& cancelled) {
  std::vector<RegistryIssue> issues = check_registry(registry, floor.map);
  for (auto* find : {find_implausible, find_blind_stretches, find_gaps}) {
    if (cancelled.stop_requested()) break;
    for (RegistryIssue& issue : find(registry, floor)) issues.push_back(std::move(issue));
  }
  return issues;
}

}  // namespace lodestar
