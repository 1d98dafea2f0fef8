#pragma once

#include <optional>
#include <queue>
#include <string>
#include <vector>

#include "maps/random.hpp"
#include "planning/collision_checker.hpp"

// Small maps, and brute-force results to compare with.
namespace lodestar {

/// Rows of text, the top one first: '#' is an obstacle, '?' unknown.
inline OccupancyMap map_from(const std::vector<std::string>& rows, double resolution_m = 1.0) {
  OccupancyMap map;
  map.columns = static_cast<int>(rows.front().size());
  map.rows = static_cast<int>(rows.size());
  map.resolution_m = resolution_m;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row) {
      map.cells.push_back(c == '#'   ? OccupancyMap::occupied
                          : c == '?' ? OccupancyMap::unknown
                                     : OccupancyMap::free);
    }
  }
  return map;
}

inline OccupancyMap random_map(Random& random, int columns, int rows, double share) {
  OccupancyMap map;
  map.columns = columns;
  map.rows = rows;
  map.resolution_m = 0.05;
  for (int i = 0; i < columns * rows; ++i) {
    map.cells.push_back(random.uniform() < share ? OccupancyMap::occupied : OccupancyMap::free);
  }
  return map;
}

/// True if a disc overlaps a cell that is not drivable, or the outside of the map. Tries every cell.
inline bool touches(const OccupancyMap& map, const Vec2& center_m, double radius_m) {
  const Vec2 p = inverse(map.map_from_grid) * center_m;
  const double width = map.columns * map.resolution_m;
  const double height = map.rows * map.resolution_m;
  constexpr double rounding = 1e-7;
  const double radius = radius_m - rounding;
  if (p.x() < radius || p.y() < radius || p.x() > width - radius || p.y() > height - radius) return true;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (is_drivable(map.at({column, row}))) continue;
      const Vec2 low(column * map.resolution_m, row * map.resolution_m);
      const Vec2 high = low.array() + map.resolution_m;
      if ((p - p.cwiseMax(low).cwiseMin(high)).norm() < radius) return true;
    }
  }
  return false;
}

/// Length in cells of the shortest 8-connected path; 1e300 without one.
inline double dijkstra(const OccupancyMap& map, const CollisionChecker& space, Cell start, Cell goal) {
  std::vector<double> best(map.cells.size(), 1e300);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[map.index(start)] = 0.0;
  open.emplace(0.0, map.index(start));
  while (!open.empty()) {
    const auto [cost, index] = open.top();
    open.pop();
    if (cost > best[index]) continue;
    const Cell cell{static_cast<int>(index) % map.columns, static_cast<int>(index) / map.columns};
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell to{cell.column + dx, cell.row + dy};
        if ((dx == 0 && dy == 0) || !space.at(to)) continue;
        if (dx != 0 && dy != 0 && !(space.at({to.column, cell.row}) && space.at({cell.column, to.row})))
          continue;
        const double next = cost + std::hypot(dx, dy);
        if (next < best[map.index(to)]) {
          best[map.index(to)] = next;
          open.emplace(next, map.index(to));
        }
      }
    }
  }
  return best[map.index(goal)];
}

/// A random cell that is clear, if a hundred tries find one.
inline std::optional<Cell> clear_cell(Random& random, const CollisionChecker& space) {
  for (int i = 0; i < 100; ++i) {
    const Cell cell{static_cast<int>(random.below(static_cast<std::uint64_t>(space.columns()))),
                    static_cast<int>(random.below(static_cast<std::uint64_t>(space.rows())))};
    if (space.at(cell)) return cell;
  }
  return std::nullopt;
}

}  // namespace lodestar
