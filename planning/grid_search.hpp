#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "maps/occupancy_map.hpp"
#include "planning/clear_space.hpp"

namespace lodestar {

/// What a way through a cell costs per unit of length: at least 1.
using CellCosts = std::vector<float>;

struct GridPath {
  std::vector<Cell> cells;   ///< from start to goal, each a neighbour of the one before
  double cost = 0.0;         ///< in cells: length times mean cost of each step's two cells
  std::size_t expanded = 0;  ///< cells taken from the open list
};

/// The cheapest path on the 8-connected grid of clear cells without cutting corners: A* with the octile
/// distance (Hart, Nilsson and Raphael 1968). Ties are broken the same way every time. Nothing when there is
/// none.
std::optional<GridPath> search_grid(const OccupancyMap& map, const ClearSpace& space, const CellCosts& costs,
                                    Cell start, Cell goal);

}  // namespace lodestar
