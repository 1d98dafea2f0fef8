#include "maps/ray_casting.hpp"

#include <cmath>
#include <limits>

namespace lodestar {
namespace {

/// The walk along one axis of the grid: which way, and how far along the ray to the next line and between
/// lines.
struct AxisWalk {
  AxisWalk(double from, double direction) {
    if (direction == 0.0) return;
    step = direction > 0.0 ? 1 : -1;
    const double cell = std::floor(from);
    next = (cell + (direction > 0.0 ? 1.0 : 0.0) - from) / direction;
    between = 1.0 / std::abs(direction);
  }

  int step = 0;
  double next = std::numeric_limits<double>::infinity();
  double between = std::numeric_limits<double>::infinity();
};

}  // namespace

/// Amanatides and Woo 1987: from cell to cell, across the nearer of the next two grid lines.
std::optional<double> range_to_obstacle_m(const OccupancyMap& map, const Vec2& from_in_map,
                                          double heading_in_map_rad, double max_range_m) {
  const Vec2 from = inverse(map.map_from_grid) * from_in_map / map.resolution_m;
  const double heading = heading_in_map_rad - map.map_from_grid.yaw_rad;
  const double range = max_range_m / map.resolution_m;
  AxisWalk along_x(from.x(), std::cos(heading));
  AxisWalk along_y(from.y(), std::sin(heading));
  Cell cell = cell_at(from);
  double gone = 0.0;
  while (gone <= range) {
    if (map.contains(cell) && map.at(cell) >= 50) return gone * map.resolution_m;
    AxisWalk& nearer = along_x.next < along_y.next ? along_x : along_y;
    gone = nearer.next;
    nearer.next += nearer.between;
    (&nearer == &along_x ? cell.column : cell.row) += nearer.step;
  }
  return std::nullopt;
}

}  // namespace lodestar
