#pragma once

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Does a disc on the floor overlap the square of a cell that is not drivable, or the world outside the map?
/// Exact; to touch an edge is not to overlap it. A place that is not finite counts as outside.
bool disc_overlaps_obstacle(const OccupancyMap& map, const Vec2& centre_in_map, double radius_m);

}  // namespace lodestar
