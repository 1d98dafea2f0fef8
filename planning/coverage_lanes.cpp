#include "planning/coverage_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "planning/coverage_gaps.hpp"

namespace lodestar {
namespace {

/// A line of cells, along a row or a column.
struct Line {
  bool is_row = true;
  int at = 0;
  [[nodiscard]] Cell cell(int along) const { return is_row ? Cell{along, at} : Cell{at, along}; }
};

/// Appends a run of cells, divided evenly where it is too long.
void append_run(const OccupancyMap& map, const Line& line, int first, int last,
                const CoverageLanesOptions& options, std::vector<Lane>& lanes) {
  const double length_m = (last - first) * map.resolution_m;
  if (length_m < options.shortest_m) return;
  const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / options.longest_m)));
  const auto at = [&](int piece) {
    return map.center_of(line.cell(first + (last - first) * piece / pieces));
  };
  for (int piece = 0; piece < pieces; ++piece) lanes.push_back({at(piece), at(piece + 1)});
}

/// The floor to cover.
struct Floor {
  const CollisionChecker& roomy;
  const CollisionChecker& passable;
  int region = 0;  ///< of the start
  [[nodiscard]] const OccupancyMap& map() const { return roomy.map(); }
  [[nodiscard]] bool has(Cell cell) const { return roomy.at(cell) && passable.region(cell) == region; }
};

void append_line(const Floor& floor, const Line& line, const CoverageLanesOptions& options,
                 std::vector<Lane>& lanes) {
  const OccupancyMap& map = floor.map();
  const int count = line.is_row ? map.columns : map.rows;
  int first = -1;
  for (int along = 0; along <= count; ++along) {
    const bool is_free = along < count && floor.has(line.cell(along));
    if (is_free && first < 0) first = along;
    if (is_free || first < 0) continue;
    append_run(map, line, first, along - 1, options, lanes);
    first = -1;
  }
}

/// The middles of equal strips, none wider than the spacing, from the first free line to the last.
std::vector<int> middles_of_strips(int first, int last, int spacing) {
  const int strips = (last - first) / spacing + 1;
  std::vector<int> lines;
  for (int i = 0; i < strips; ++i) lines.push_back(first + (2 * i + 1) * (last - first) / (2 * strips));
  return lines;
}

}  // namespace

std::vector<Lane> coverage_lanes(const CollisionChecker& roomy, const CollisionChecker& passable,
                                 const Vec2& start_m, const CoverageLanesOptions& options) {
  const OccupancyMap& map = roomy.map();
  const Cell start = map.cell_at(start_m);
  if (!passable.at(start)) return {};
  const Floor floor{roomy, passable, passable.region(start)};
  Eigen::AlignedBox2i free;
  std::vector<bool> is_floor(map.cells.size(), false);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (!floor.has({column, row})) continue;
      is_floor[map.index({column, row})] = true;
      free.extend(Eigen::Vector2i(column, row));
    }
  }
  if (free.isEmpty()) return {};
  const int spacing = std::max(1, static_cast<int>(options.spacing_m / map.resolution_m));
  std::vector<Lane> lanes;
  for (const int row : middles_of_strips(free.min().y(), free.max().y(), spacing))
    append_line(floor, {true, row}, options, lanes);
  for (const int column : middles_of_strips(free.min().x(), free.max().x(), spacing))
    append_line(floor, {false, column}, options, lanes);
  // In the open, the next lane is half a spacing away.
  const double reach_m = 0.5 * options.spacing_m + map.resolution_m;
  const std::vector<Lane> more = lanes_through_gaps(roomy, is_floor, lanes, reach_m);
  lanes.insert(lanes.end(), more.begin(), more.end());
  return lanes;
}

}  // namespace lodestar
