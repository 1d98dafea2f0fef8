#include "maps/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {
namespace {

/// Floor as an int; far-away or non-finite coordinates saturate at the limits of int instead of causing
/// undefined behaviour.
int floor_to_int(double value) {
  constexpr double limit = std::numeric_limits<int>::max();
  if (std::isnan(value)) return std::numeric_limits<int>::min();
  return static_cast<int>(std::clamp(std::floor(value), -limit, limit));
}

}  // namespace

Cell OccupancyMap::cell_at(const Vec2& point_in_map) const {
  const Vec2 point_in_grid =
      Eigen::Rotation2Dd(-map_from_grid.yaw_rad) * (point_in_map - map_from_grid.position_m) / resolution_m;
  return {floor_to_int(point_in_grid.x()), floor_to_int(point_in_grid.y())};
}

Vec2 OccupancyMap::center_of(Cell cell) const {
  return map_from_grid * Vec2((cell.column + 0.5) * resolution_m, (cell.row + 0.5) * resolution_m);
}

}  // namespace lodestar
