#pragma once

#include <optional>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// How far a ray goes to the nearest cell that is not free: its value is 50 or more. Unknown cells and what
/// is outside the map are transparent. Nothing when it meets none within the range.
std::optional<double> range_to_obstacle_m(const OccupancyMap& map, const Vec2& from_in_map,
                                          double heading_in_map_rad, double max_range_m);

}  // namespace lodestar
