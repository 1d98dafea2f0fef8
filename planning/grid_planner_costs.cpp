#include <algorithm>
#include <cmath>

#include "maps/distance_field.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {

void GridPlanner::weigh_cells() {
  const bool keeps_clear = options_.clearance_weight > 0.0 && options_.preferred_clearance_m > 0.0;
  if (!keeps_clear && options_.avoided.places_m.empty()) return;
  costs_.assign(map_.cells.size(), 1.0F);
  if (keeps_clear) weigh_near_obstacles();
  weigh_avoided();
}

/// Inflation: a cell costs 1 at the preferred clearance, and linearly more the nearer it is.
void GridPlanner::weigh_near_obstacles() {
  const auto weigh = [&](std::size_t index, double to_obstacle_cells) {
    const double to_edge_m = (to_obstacle_cells - 0.5) * map_.resolution_m;
    const double missing = 1.0 - (to_edge_m - options_.radius_m) / options_.preferred_clearance_m;
    costs_[index] = static_cast<float>(1.0 + options_.clearance_weight * std::clamp(missing, 0.0, 1.0));
  };
  const double widest_cells = (options_.radius_m + options_.preferred_clearance_m) / map_.resolution_m + 0.5;
  if (widest_cells * widest_cells < ObstacleField::far) {
    for (std::size_t i = 0; i < costs_.size(); ++i) weigh(i, field_->distance_cells(i));
    return;
  }
  const DistanceField distances(map_);  // beyond the field's range
  for (int row = 0; row < map_.rows; ++row)
    for (int column = 0; column < map_.columns; ++column)
      weigh(map_.index({column, row}),
            std::sqrt(static_cast<double>(distances.squared_cells({column, row}))));
}

/// Weighs a cell once, however many places are near.
void GridPlanner::weigh_avoided() {
  const AvoidedArea& avoided = options_.avoided;
  const double within = avoided.within_m / map_.resolution_m;
  std::vector<bool> is_avoided(costs_.size(), false);
  for (const Vec2& place_m : avoided.places_m) {
    const Vec2 place = in_grid(place_m);
    const Cell low = cell_at(place - Vec2::Constant(within));
    const Cell high = cell_at(place + Vec2::Constant(within));
    for (int row = std::max(low.row, 0); row <= std::min(high.row, map_.rows - 1); ++row)
      for (int column = std::max(low.column, 0); column <= std::min(high.column, map_.columns - 1); ++column)
        if ((center_of({column, row}) - place).norm() <= within) is_avoided[map_.index({column, row})] = true;
  }
  for (std::size_t i = 0; i < costs_.size(); ++i)
    if (is_avoided[i]) costs_[i] *= static_cast<float>(1.0 + avoided.weight);
}

}  // namespace lodestar
