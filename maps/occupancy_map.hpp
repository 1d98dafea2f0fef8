#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// A cell of the grid: column along the grid's x, row along its y. Row 0 is the bottom row, as in ROS.
struct Cell {
  int column = 0;
  int row = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The centre of a cell in grid coordinates: in units of cells from the grid's lower-left corner.
inline Vec2 center_of(Cell cell) {
  return {cell.column + 0.5, cell.row + 0.5};
}

/// The cell that holds a point in grid coordinates, which must lie within the range of int.
inline Cell cell_at(const Vec2& point_in_grid) {
  return {static_cast<int>(std::floor(point_in_grid.x())), static_cast<int>(std::floor(point_in_grid.y()))};
}

/// Occupancy grid: ROS values (0 free .. 100 occupied, -1 unknown) on a grid that may be rotated in the map
/// frame.
struct OccupancyMap {
  static constexpr std::int8_t free = 0;
  static constexpr std::int8_t occupied = 100;
  static constexpr std::int8_t unknown = -1;

  int columns = 0;
  int rows = 0;
  double resolution_m = 0.0;
  Pose2 map_from_grid;             ///< pose of the lower-left corner of cell (0, 0): the file's `origin`
  std::vector<std::int8_t> cells;  ///< row by row from the bottom

  [[nodiscard]] bool contains(Cell cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < columns && cell.row < rows;
  }
  [[nodiscard]] std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(cell.column);
  }
  [[nodiscard]] std::int8_t at(Cell cell) const { return cells[index(cell)]; }

  /// The cell that contains a point of the map frame; it may lie outside the grid (see contains()).
  [[nodiscard]] Cell cell_at(const Vec2& point_in_map) const;
  /// The centre of a cell in the map frame.
  [[nodiscard]] Vec2 center_of(Cell cell) const;
};

/// Whether the robot may be over a cell of this value. Unknown counts as not drivable.
constexpr bool is_drivable(std::int8_t value) {
  return value >= 0 && value < 50;
}

/// Whether beams end at a cell of this value, as far as the map knows.
constexpr bool is_wall(std::int8_t value) {
  return value >= 0 && !is_drivable(value);
}

}  // namespace lodestar
