#pragma once

#include <span>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Something that hangs or stands out above the floor, as a table's top or a fork: an upright box in the map.
/// A scanner's beams pass below it.
struct Overhang {
  Vec2 low_m = Vec2::Zero();
  Vec2 high_m = Vec2::Zero();
  double bottom_m = 0.7;
  double top_m = 0.75;
};

/// The map with the cells occupied over which something hangs lower than the robot is high.
inline OccupancyMap with_overhangs(const OccupancyMap& map, std::span<const Overhang> overhangs,
                                   double robot_height_m) {
  OccupancyMap solid = map;
  for (const Overhang& overhang : overhangs) {
    if (overhang.bottom_m >= robot_height_m) continue;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column) {
        const Vec2 center_m = map.center_of({column, row});
        if ((center_m.array() >= overhang.low_m.array()).all() &&
            (center_m.array() <= overhang.high_m.array()).all())
          solid.cells[map.index({column, row})] = OccupancyMap::occupied;
      }
  }
  return solid;
}

}  // namespace lodestar
