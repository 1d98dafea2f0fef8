#pragma once

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Nothing but free cells, one corner at the map's origin.
inline OccupancyMap empty_floor(int columns, int rows, double resolution_m) {
  OccupancyMap map;
  map.columns = columns;
  map.rows = rows;
  map.resolution_m = resolution_m;
  map.cells.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), OccupancyMap::free);
  return map;
}

}  // namespace lodestar
