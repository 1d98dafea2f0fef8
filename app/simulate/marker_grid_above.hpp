#pragma once

#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Markers in a grid about 1.5 m apart at a height of 2.6 m, above all of a map that a robot can come near.
/// Their codes are as far apart as so many IDs can be; where there are more places than IDs, the grid is
/// wider.
MarkerRegistry marker_grid_above(const OccupancyMap& map);

}  // namespace lodestar
