#include "control/forward_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestar {

ForwardClearance::ForwardClearance(const OccupancyMap& map, double radius_m, double tolerance_m)
    : map_(map), distances_(map), radius_m_(radius_m - tolerance_m) {}

/// Sphere tracing (Hart 1996): each step is as long as the distance to the nearest obstacle.
double ForwardClearance::ahead_m(const Pose2& map_from_base, double up_to_m,
                                 const SafetyMargin& spare) const {
  const Vec2 ahead(std::cos(map_from_base.yaw_rad), std::sin(map_from_base.yaw_rad));
  const double step_m = 0.2 * map_.resolution_m;
  const auto room_after = [&](double way_m) {
    return room_m(map_from_base.position_m + way_m * ahead, radius_m_ + spare.here_m + way_m * spare.per_m);
  };
  const double least_room_m = std::min(room_after(0.0), 0.0);
  double way_m = 0.0;
  while (way_m < up_to_m) {
    const double room = room_after(way_m);
    if (room < least_room_m) return std::max(way_m - step_m, 0.0);
    way_m += std::max(room / (1.0 + spare.per_m), step_m);
  }
  return up_to_m;
}

/// Far from obstacles the distance field, from cell centre to cell centre, suffices as a lower bound; near
/// them the distance is exact.
double ForwardClearance::room_m(const Vec2& point_in_map, double radius_m) const {
  const Cell cell = map_.cell_at(point_in_map);
  if (!map_.contains(cell)) return -radius_m;
  const double half_diagonal_m = map_.resolution_m * std::numbers::sqrt2 / 2.0;
  const double at_least_m = distances_.distance_m(cell) - 2.0 * half_diagonal_m;
  return (at_least_m > radius_m ? at_least_m : exact_distance_m(point_in_map, radius_m)) - radius_m;
}

/// Distance to the nearest cell (a square) that is not drivable; searches up to the radius plus 2 cells.
double ForwardClearance::exact_distance_m(const Vec2& point_in_map, double radius_m) const {
  const Vec2 point_in_grid = inverse(map_.map_from_grid) * point_in_map;
  const Cell middle = map_.cell_at(point_in_map);
  const int reach = static_cast<int>(std::ceil(radius_m / map_.resolution_m)) + 2;
  double nearest_m = reach * map_.resolution_m;
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      const Cell cell{column, row};
      if (map_.contains(cell) && is_drivable(map_.at(cell))) continue;
      const Vec2 low = map_.resolution_m * Vec2(column, row);
      const Vec2 high = low.array() + map_.resolution_m;
      const Vec2 nearest = point_in_grid.cwiseMax(low).cwiseMin(high);
      nearest_m = std::min(nearest_m, (point_in_grid - nearest).norm());
    }
  }
  return nearest_m;
}

}  // namespace lodestar
