#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Calls `visit(cell, enters, leaves)` for each cell that the way between two points passes through, in
/// order, until it returns false (Amanatides and Woo 1987). Points are in grid coordinates, whose unit is one
/// cell, within the range of int; `enters` and `leaves` are shares of the way, 0 at its start and 1 at its
/// end. Cells may lie outside the grid.
template <typename Visit>
void walk_grid(const Vec2& from_in_grid, const Vec2& to_in_grid, Visit visit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const Vec2 way = to_in_grid - from_in_grid;
  Cell cell = cell_at(from_in_grid);
  const Cell last = cell_at(to_in_grid);
  const int step_column = way.x() > 0.0 ? 1 : -1;
  const int step_row = way.y() > 0.0 ? 1 : -1;
  const auto first_border = [&](double from, double along, int index) {
    if (along == 0.0) return never;
    return ((along > 0.0 ? index + 1 : index) - from) / along;
  };
  double next_column = first_border(from_in_grid.x(), way.x(), cell.column);
  double next_row = first_border(from_in_grid.y(), way.y(), cell.row);
  const double per_column = way.x() == 0.0 ? never : std::abs(1.0 / way.x());
  const double per_row = way.y() == 0.0 ? never : std::abs(1.0 / way.y());
  int columns_left = std::abs(last.column - cell.column);
  int rows_left = std::abs(last.row - cell.row);
  double enters = 0.0;
  // Counted, so that rounding where a border ends the way leads neither past it nor elsewhere.
  for (;;) {
    if (columns_left == 0) next_column = never;
    if (rows_left == 0) next_row = never;
    const double leaves = std::min({next_column, next_row, 1.0});
    if (!visit(cell, enters, leaves) || columns_left + rows_left == 0) return;
    enters = leaves;
    if (columns_left > 0 && next_column <= next_row) {
      next_column += per_column;
      cell.column += step_column;
      --columns_left;
    } else {
      next_row += per_row;
      cell.row += step_row;
      --rows_left;
    }
  }
}

}  // namespace lodestar
