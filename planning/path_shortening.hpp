#pragma once

#include <vector>

#include "planning/grid_search.hpp"

namespace lodestar {

/// Few straight legs instead of many small steps: the cheapest chain of clear legs over the given points,
/// which keeps their first and last. A leg costs its length times what its cells cost, and a turn as much as
/// `turn_cost_cells` of way. Points and result in grid coordinates.
std::vector<Vec2> shortened(const std::vector<Vec2>& points, const OccupancyMap& map, const ClearSpace& space,
                            const CellCosts& costs, double turn_cost_cells);

}  // namespace lodestar
