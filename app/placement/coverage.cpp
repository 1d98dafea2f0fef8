#include "app/placement/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "app/placement/lines_of_sight.hpp"
#include "app/placement/plausibility.hpp"

namespace lodestar {
namespace {

constexpr double most_blind_m = 1.0;  ///< of a route to drive by odometry alone
constexpr double least_gap_m2 = 0.1;

/// A marker's centre, in cells, and the radius in cells within which a robot sees it at every heading.
struct MarkerDisc {
  Vec2 middle = Vec2::Zero();
  double z_m = 0.0;
  double reach = 0.0;
};

std::vector<MarkerDisc> marker_discs(const MarkerRegistry& registry, const CoveredFloor& floor,
                                     const LinesOfSight& sight) {
  std::vector<MarkerDisc> all;
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec3 middle = center_in_map(registry, marker);
    all.push_back({sight.in_cells(middle.head<2>()), middle.z(),
                   floor.view.reach_m(middle.z()) / floor.map.resolution_m});
  }
  return all;
}

bool is_free_at(const OccupancyMap& map, Cell cell) {
  return map.contains(cell) && is_drivable(map.at(cell));
}

/// Is it not free, with a free cell beside it? The cell nearest to a free one that is not free always is such
/// a cell.
bool is_edge(const OccupancyMap& map, Cell cell) {
  if (is_free_at(map, cell)) return false;
  const auto [column, row] = cell;
  return is_free_at(map, {column - 1, row}) || is_free_at(map, {column + 1, row}) ||
         is_free_at(map, {column, row - 1}) || is_free_at(map, {column, row + 1});
}

/// For each cell: true where all cells within `room`, in cells, are free. Of a large map most is far from any
/// edge, so that this takes less time than a distance field.
std::vector<bool> cells_with_room(const OccupancyMap& map, double room) {
  std::vector<bool> has_room(map.cells.size());
  for (std::size_t i = 0; i < has_room.size(); ++i) has_room[i] = is_drivable(map.cells[i]);
  const auto reach = static_cast<int>(room);
  const auto close_about = [&](Cell edge) {
    for (int row = std::max(0, edge.row - reach); row <= std::min(map.rows - 1, edge.row + reach); ++row) {
      const int half = static_cast<int>(std::sqrt(room * room - (row - edge.row) * (row - edge.row)));
      const int last = std::min(map.columns - 1, edge.column + half);
      for (int column = std::max(0, edge.column - half); column <= last; ++column)
        has_room[map.index({column, row})] = false;
    }
  };
  for (int row = -1; row <= map.rows; ++row)
    for (int column = -1; column <= map.columns; ++column)
      if (is_edge(map, {column, row})) close_about({column, row});
  return has_room;
}

/// Of the square about a marker's disc. A line of sight from the marker stays in one of them.
using Quarters = std::array<bool, 4>;

std::size_t quarter_of(const Vec2& from_marker) {
  return (from_marker.x() < 0.0 ? 0U : 1U) + (from_marker.y() < 0.0 ? 0U : 2U);
}

/// True for those in which nothing hides the marker.
Quarters clear_quarters(const MarkerDisc& marker, const LinesOfSight& sight) {
  Quarters are_clear{};
  for (const double x : {-marker.reach, marker.reach}) {
    for (const double y : {-marker.reach, marker.reach}) {
      const Vec2 corner = marker.middle + Vec2(x, y);
      are_clear[quarter_of({x, y})] =
          sight.is_clear(cell_at(marker.middle.cwiseMin(corner)), cell_at(marker.middle.cwiseMax(corner)));
    }
  }
  return are_clear;
}

/// For each cell: true where the robot can be but sees no marker.
std::vector<bool> blind_cells(const MarkerRegistry& registry, const CoveredFloor& floor) {
  const OccupancyMap& map = floor.map;
  std::vector<bool> blind = cells_with_room(map, floor.room_m / map.resolution_m);
  const LinesOfSight sight(floor);
  for (const MarkerDisc& marker : marker_discs(registry, floor, sight)) {
    const Vec2 low = (marker.middle.array() - marker.reach).floor().max(0.0);
    const Vec2 high = marker.middle.array() + marker.reach;
    const Quarters is_clear = clear_quarters(marker, sight);
    for (int row = static_cast<int>(low.y()); row < std::min<double>(map.rows, high.y()); ++row) {
      for (int column = static_cast<int>(low.x()); column < std::min<double>(map.columns, high.x());
           ++column) {
        const std::size_t index = map.index({column, row});
        const Vec2 at = center_of({column, row});
        if (!blind[index] || (at - marker.middle).squaredNorm() > marker.reach * marker.reach) continue;
        if (is_clear[quarter_of(at - marker.middle)] || sight.is_free(at, marker.middle, marker.z_m))
          blind[index] = false;
      }
    }
  }
  return blind;
}

/// Cells beside each other in a row, from the first column to the last.
struct RowOfCells {
  int row = 0;
  int first = 0;
  int last = 0;
};

/// The blind cells connected to this one, by runs (scan-line flood fill: Smith 1979, "Tint fill"); clears
/// them in `blind`.
std::vector<RowOfCells> taken_from(std::vector<bool>& blind, const OccupancyMap& map, Cell first) {
  const auto is_blind = [&](int column, int row) {
    return map.contains({column, row}) && blind[map.index({column, row})];
  };
  std::vector<RowOfCells> runs;
  std::vector<Cell> seeds{first};
  while (!seeds.empty()) {
    const Cell seed = seeds.back();
    seeds.pop_back();
    if (!is_blind(seed.column, seed.row)) continue;
    RowOfCells run{seed.row, seed.column, seed.column};
    while (is_blind(run.first - 1, run.row)) --run.first;
    while (is_blind(run.last + 1, run.row)) ++run.last;
    for (int column = run.first; column <= run.last; ++column) blind[map.index({column, run.row})] = false;
    for (const int row : {run.row - 1, run.row + 1})
      for (int column = run.first; column <= run.last; ++column)
        if (is_blind(column, row) && (column == run.first || !is_blind(column - 1, row)))
          seeds.push_back({column, row});
    runs.push_back(run);
  }
  return runs;
}

double cells_in(const std::vector<RowOfCells>& runs) {
  double cells = 0.0;
  for (const RowOfCells& run : runs) cells += run.last - run.first + 1;
  return cells;
}

/// The cell of a run that is nearest to a point of the grid.
Cell nearest_in(const RowOfCells& run, const Vec2& at) {
  return {std::clamp(cell_at(at).column, run.first, run.last), run.row};
}

/// Its places are the corners of its bounding box, for a view to zoom to.
RegistryIssue gap_issue(const OccupancyMap& map, const std::vector<RowOfCells>& runs, double area_m2) {
  Vec2 low = Vec2::Constant(1e300);
  Vec2 high = -low;
  for (const RowOfCells& run : runs) {
    for (const int column : {run.first, run.last}) {
      const Vec2 end = map.center_of({column, run.row});
      low = low.cwiseMin(end);
      high = high.cwiseMax(end);
    }
  }
  const Vec2 middle = inverse(map.map_from_grid) * (0.5 * (low + high)) / map.resolution_m;
  const auto off = [&](const RowOfCells& run) {
    return (center_of(nearest_in(run, middle)) - middle).squaredNorm();
  };
  const Vec2 at = map.center_of(nearest_in(*std::ranges::min_element(runs, {}, off), middle));
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

std::vector<BlindStretch> blind_stretches(const Path& route, const LinesOfSight& sight,
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
      const std::vector<RowOfCells> runs = taken_from(blind, map, {column, row});
      const double area_m2 = cells_in(runs) * map.resolution_m * map.resolution_m;
      if (area_m2 >= least_gap_m2) gaps.emplace_back(area_m2, gap_issue(map, runs, area_m2));
    }
  }
  std::ranges::stable_sort(gaps, std::ranges::greater(), &std::pair<double, RegistryIssue>::first);
  std::vector<RegistryIssue> issues;
  for (auto& [area_m2, gap] : gaps) issues.push_back(std::move(gap));
  return issues;
}

std::vector<BlindStretch> blind_stretches_of(const Path& way, const MarkerRegistry& registry,
                                             const CoveredFloor& floor) {
  const LinesOfSight sight(floor);
  return blind_stretches(way, sight, marker_discs(registry, floor, sight));
}

std::vector<RegistryIssue> find_blind_stretches(const MarkerRegistry& registry, const CoveredFloor& floor) {
  const LinesOfSight sight(floor);
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
