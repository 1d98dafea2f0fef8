#pragma once

#include <cstdint>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Exact collision checks for a disc-shaped robot. In grid coordinates: the unit is a cell, cell (0, 0) goes
/// from (0, 0) to (1, 1), its centre is (0.5, 0.5). Touching an obstacle's edge is allowed, overlapping it is
/// not; outside the map is obstacle.
class CollisionChecker {
 public:
  CollisionChecker(const OccupancyMap& map, double radius_m);

  [[nodiscard]] int columns() const { return map_.columns; }
  [[nodiscard]] int rows() const { return map_.rows; }

  /// Is the disc at this cell's centre clear of cells that are not drivable? Exact. When a cell and its
  /// neighbour in a row or column are clear, so is the leg between their centres, as an obstacle square is as
  /// wide as the step; and when four cells in a square are clear, so are its diagonals.
  [[nodiscard]] bool at(Cell cell) const { return map_.contains(cell) && clear_[map_.index(cell)] != 0; }

  /// Is the disc clear all along a straight leg? Exact, for any two points.
  [[nodiscard]] bool along(const Vec2& from, const Vec2& to) const;

  /// Distance in cells from a cell's centre to that of the nearest one that is not drivable.
  [[nodiscard]] double to_obstacle_cells(Cell cell) const {
    return static_cast<double>(to_obstacle_[map_.index(cell)]);
  }
  [[nodiscard]] const OccupancyMap& map() const { return map_; }
  [[nodiscard]] double radius_cells() const { return radius_cells_; }

  /// Cells with the same label, and only those, can be reached from each other; 0 for cells that are not
  /// clear.
  [[nodiscard]] int region(Cell cell) const { return regions_[map_.index(cell)]; }

 private:
  void block_around(Cell obstacle);
  void block_border();
  void label_regions();
  void flood(Cell seed, int label);
  void measure_distances();
  [[nodiscard]] bool stretch_is_clear(const Vec2& from, const Vec2& to) const;
  [[nodiscard]] bool row_is_clear(int row, const Vec2& from, const Vec2& to) const;

  const OccupancyMap& map_;
  double radius_cells_ = 0.0;
  std::vector<std::uint8_t> clear_;
  std::vector<int> regions_;
  std::vector<float> to_obstacle_;  ///< as to_obstacle_cells()
};

}  // namespace lodestar
