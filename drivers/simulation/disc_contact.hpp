#pragma once

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// True when a disc on the floor overlaps a cell that is not drivable, or the outside of the map. Exact;
/// touching an edge is not overlapping. A position that is not finite counts as outside.
bool disc_overlaps_obstacle(const OccupancyMap& map, const Vec2& centre_in_map, double radius_m);

}  // namespace lodestar
