#include "control/forward_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lodestar {

ForwardClearance::ForwardClearance(std::shared_ptr<const ObstacleField> field, double radius_m,
                                   double tolerance_m)
    : field_(std::move(field)), discs_{{Vec2::Zero(), radius_m - tolerance_m}} {}

ForwardClearance::ForwardClearance(std::shared_ptr<const ObstacleField> field, const Footprint& footprint,
                                   double tolerance_m)
    : field_(std::move(field)), discs_(footprint.inner_discs(tolerance_m)) {}

/// Sphere tracing (Hart 1996): each step is as long as the distance to the nearest obstacle.
double ForwardClearance::ahead_m(const Pose2& map_from_base, double up_to_m,
                                 const SafetyMargin& spare) const {
  const Vec2 ahead(std::cos(map_from_base.yaw_rad), std::sin(map_from_base.yaw_rad));
  const double step_m = 0.2 * field_->map().resolution_m;
  const auto room_after = [&](double way_m) {
    return room_m(Pose2{map_from_base.position_m + way_m * ahead, map_from_base.yaw_rad},
                  spare.here_m + way_m * spare.per_m);
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

double ForwardClearance::room_m(const Pose2& map_from_base, double more_m) const {
  double least_m = std::numeric_limits<double>::infinity();
  for (const InnerDisc& disc : discs_)
    least_m = std::min(least_m, room_m(map_from_base * disc.center_m, disc.radius_m + more_m));
  return least_m;
}

/// Far from obstacles the distance field, from cell centre to cell centre, suffices as a lower bound; near
/// them the distance is exact.
double ForwardClearance::room_m(const Vec2& point_in_map, double radius_m) const {
  const OccupancyMap& map = field_->map();
  const Cell cell = map.cell_at(point_in_map);
  if (!map.contains(cell)) return -radius_m;
  const double between_centers = std::sqrt(static_cast<double>(field_->squared_cells(map.index(cell))));
  const double at_least_m = map.resolution_m * (between_centers - std::numbers::sqrt2);
  return (at_least_m > radius_m ? at_least_m : exact_distance_m(point_in_map, radius_m)) - radius_m;
}

/// Distance to the nearest cell (a square) that is not drivable; searches up to the radius plus 2 cells.
double ForwardClearance::exact_distance_m(const Vec2& point_in_map, double radius_m) const {
  const OccupancyMap& map = field_->map();
  const Vec2 point_in_grid = inverse(map.map_from_grid) * point_in_map;
  const Cell middle = map.cell_at(point_in_map);
  const int reach = static_cast<int>(std::ceil(radius_m / map.resolution_m)) + 2;
  double nearest_m = reach * map.resolution_m;
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      const Cell cell{column, row};
      if (map.contains(cell) && is_drivable(map.at(cell))) continue;
      const Vec2 low = map.resolution_m * Vec2(column, row);
      const Vec2 high = low.array() + map.resolution_m;
      const Vec2 nearest = point_in_grid.cwiseMax(low).cwiseMin(high);
      nearest_m = std::min(nearest_m, (point_in_grid - nearest).norm());
    }
  }
  return nearest_m;
}

}  // namespace lodestar
