#pragma once

#include <span>

#include "maps/occupancy_map.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// What a robot obeys on a map besides its obstacles.
struct Zones {
  std::vector<KeepOut> keep_out;
  std::vector<SpeedZone> speed_zones;
};

/// The map with every cell occupied of which a keep-out covers any part: for planning and for checks of
/// poses. Not for what a scanner sees: there is nothing to see.
OccupancyMap with_keep_out(OccupancyMap map, std::span<const KeepOut> keep_out);

/// From a point to a polygon of either sense of rotation, in its unit; 0 inside.
double distance_to(const Polygon& polygon, const Vec2& point);

}  // namespace lodestar
