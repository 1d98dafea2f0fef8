#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "maps/obstacle_field.hpp"
#include "planning/regions.hpp"

namespace lodestar {

/// Exact collision checks for a disc-shaped robot. In grid coordinates: the unit is a cell, cell (0, 0) goes
/// from (0, 0) to (1, 1), its centre is (0.5, 0.5). Touching an obstacle's edge is allowed, overlapping it is
/// not; outside the map is obstacle.
class CollisionChecker {
 public:
  /// Checkers of several radii on one map share its field.
  CollisionChecker(std::shared_ptr<const ObstacleField> field, double radius_m);
  /// With a copy of the map.
  CollisionChecker(const OccupancyMap& map, double radius_m);

  [[nodiscard]] int columns() const { return map_.columns; }
  [[nodiscard]] int rows() const { return map_.rows; }

  /// Is the disc at this cell's centre clear of cells that are not drivable? Exact. When a cell and its
  /// neighbour in a row or column are clear, so is the leg between their centres, as an obstacle square is as
  /// wide as the step; and when four cells in a square are clear, so are its diagonals.
  [[nodiscard]] bool at(Cell cell) const {
    if (!map_.contains(cell)) return false;
    const auto column = static_cast<std::size_t>(cell.column);
    return ((clear_[word(cell.row) + column / 64U] >> (column % 64U)) & 1U) != 0;
  }

  /// May the disc be clear somewhere in this cell of the map? Where it is, surely; seldom where it is not.
  [[nodiscard]] bool is_in_part_clear(Cell cell) const {
    const auto column = static_cast<std::size_t>(cell.column);
    return ((in_part_clear_[word(cell.row) + column / 64U] >> (column % 64U)) & 1U) != 0;
  }

  /// Is the disc clear all along a straight leg? Exact, for any two points.
  [[nodiscard]] bool along(const Vec2& from, const Vec2& to) const;

  /// The same; where a cell is found that blocks the leg, it is remembered. Of legs that differ little, most
  /// are blocked by the same cell: asking is_blocked_by() first saves most of the work.
  [[nodiscard]] bool along(const Vec2& from, const Vec2& to, std::optional<Cell>& blocking) const;
  [[nodiscard]] bool is_blocked_by(Cell obstacle, const Vec2& from, const Vec2& to) const;

  /// How far the disc can go from a point in a direction of length 1 and surely stay clear: up to two cells
  /// less than it could.
  [[nodiscard]] double clear_length(const Vec2& from, const Vec2& direction) const;

  /// A look at a few points of a leg: true only if it is blocked. Much cheaper than along() for legs through
  /// walls.
  [[nodiscard]] bool is_surely_blocked(const Vec2& from, const Vec2& to) const;

  [[nodiscard]] const ObstacleField& field() const { return *field_; }
  [[nodiscard]] const std::shared_ptr<const ObstacleField>& shared_field() const { return field_; }
  [[nodiscard]] const OccupancyMap& map() const { return map_; }
  [[nodiscard]] double radius_cells() const { return radius_cells_; }

  /// Cells with the same label, and only those, can be reached from each other; 0 for cells that are not
  /// clear.
  [[nodiscard]] int region(Cell cell) const { return regions_.label(cell); }

 private:
  [[nodiscard]] std::size_t word(int row) const { return static_cast<std::size_t>(row) * words_a_row_; }
  [[nodiscard]] double in_part_cells() const;
  void clear_drivable();
  void block_around_obstacles();
  [[nodiscard]] static std::vector<int> spans_within(double distance_cells);
  void block_around(Cell obstacle, std::span<const int> spans, std::vector<std::uint64_t>& bits);
  void block_border(double distance_cells, std::vector<std::uint64_t>& bits);
  void block(int row, int first, int last, std::vector<std::uint64_t>& bits);
  [[nodiscard]] double length_to_border(const Vec2& from, const Vec2& direction) const;
  [[nodiscard]] std::optional<Cell> obstacle_around(const Vec2& point) const;
  [[nodiscard]] std::optional<Cell> obstacle_on_stretch(const Vec2& from, const Vec2& to) const;

  std::shared_ptr<const ObstacleField> field_;
  const OccupancyMap& map_;
  double radius_cells_ = 0.0;
  std::size_t words_a_row_ = 0;
  std::vector<std::uint64_t> clear_;  ///< bits, as the field's obstacles: is the disc clear at the centre?
  std::vector<std::uint64_t> in_part_clear_;  ///< bits: unless 1, the disc is clear nowhere in the cell
  Regions regions_;
};

}  // namespace lodestar
