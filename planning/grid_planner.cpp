#include "planning/grid_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/clear_space.hpp"
#include "planning/grid_search.hpp"
#include "planning/path_shortening.hpp"

namespace lodestar {
namespace {

Cell cell_of(const Vec2& point_in_grid) {
  return {static_cast<int>(std::floor(point_in_grid.x())), static_cast<int>(std::floor(point_in_grid.y()))};
}

Vec2 center_of(Cell cell) {
  return {cell.column + 0.5, cell.row + 0.5};
}

}  // namespace

std::string_view to_string(PlanFailure failure) {
  switch (failure) {
    case PlanFailure::start_outside_map:
      return "start outside the map";
    case PlanFailure::goal_outside_map:
      return "goal outside the map";
    case PlanFailure::start_occupied:
      return "start occupied";
    case PlanFailure::goal_occupied:
      return "goal occupied";
    case PlanFailure::no_path:
      return "no path to the goal";
  }
  return "";
}

GridPlanner::GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options)
    : map_(map),
      options_(options),
      space_(std::make_unique<ClearSpace>(map_, options.radius_m)),
      costs_(map.cells.size(), 1.0F) {
  weigh_cells();
}

GridPlanner::~GridPlanner() = default;

/// A cell costs 1 when it is as far from obstacles as preferred, and linearly more the nearer it is.
void GridPlanner::weigh_cells() {
  if (!(options_.clearance_weight > 0.0 && options_.preferred_clearance_m > 0.0)) return;
  const DistanceField distance(map_);
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      const double to_edge_m = distance.distance_m({column, row}) - 0.5 * map_.resolution_m;
      const double missing = 1.0 - (to_edge_m - options_.radius_m) / options_.preferred_clearance_m;
      costs_[map_.index({column, row})] =
          static_cast<float>(1.0 + options_.clearance_weight * std::clamp(missing, 0.0, 1.0));
    }
  }
}

Vec2 GridPlanner::in_grid(const Vec2& point_m) const {
  return inverse(map_.map_from_grid) * point_m / map_.resolution_m;
}

Vec2 GridPlanner::in_map(const Vec2& point_in_grid) const {
  return map_.map_from_grid * (point_in_grid * map_.resolution_m);
}

bool GridPlanner::is_clear(const Vec2& from_m, const Vec2& to_m) const {
  return space_->along(in_grid(from_m), in_grid(to_m));
}

/// The nearest clear cell whose centre can be reached straight from the point.
std::optional<Cell> GridPlanner::clear_cell_near(const Vec2& point_in_grid) const {
  const Cell middle = cell_of(point_in_grid);
  std::optional<Cell> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int row = middle.row - 1; row <= middle.row + 1; ++row) {
    for (int column = middle.column - 1; column <= middle.column + 1; ++column) {
      const Cell cell{column, row};
      const double distance = (center_of(cell) - point_in_grid).squaredNorm();
      if (distance >= least || !space_->at(cell) || !space_->along(point_in_grid, center_of(cell))) continue;
      least = distance;
      nearest = cell;
    }
  }
  return nearest;
}

/// From a place too near to an obstacle, the nearest clear cell within the radius, straight over drivable
/// cells.
std::optional<Cell> GridPlanner::way_out(const Vec2& start_in_grid) const {
  const Cell start = cell_of(start_in_grid);
  const int reach = 1 + static_cast<int>(std::ceil(options_.radius_m / map_.resolution_m));
  const ClearSpace point_robot(map_, 0.0);
  std::optional<Cell> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int row = start.row - reach; row <= start.row + reach; ++row) {
    for (int column = start.column - reach; column <= start.column + reach; ++column) {
      const Cell cell{column, row};
      const double distance = (center_of(cell) - start_in_grid).squaredNorm();
      if (distance >= least || !space_->at(cell) || !point_robot.along(start_in_grid, center_of(cell)))
        continue;
      least = distance;
      nearest = cell;
    }
  }
  return nearest;
}

PlanResult GridPlanner::plan(const Vec2& start_m, const Vec2& goal_m) const {
  const Vec2 start = in_grid(start_m);
  const Vec2 goal = in_grid(goal_m);
  if (!start.allFinite() || !map_.contains(map_.cell_at(start_m))) return PlanFailure::start_outside_map;
  if (!goal.allFinite() || !map_.contains(map_.cell_at(goal_m))) return PlanFailure::goal_outside_map;
  if (!is_drivable(map_.at(cell_of(start)))) return PlanFailure::start_occupied;
  if (!space_->along(goal, goal)) return PlanFailure::goal_occupied;

  const bool stands_clear = space_->along(start, start);
  const std::optional<Cell> first = stands_clear ? clear_cell_near(start) : way_out(start);
  const std::optional<Cell> last = clear_cell_near(goal);
  if (!first) return stands_clear ? PlanFailure::no_path : PlanFailure::start_occupied;
  if (!last) return PlanFailure::no_path;
  const std::optional<GridPath> found = GridSearch(*space_, costs_).find(*first, *last);
  if (!found) return PlanFailure::no_path;

  std::vector<Vec2> points;
  if (stands_clear) points.push_back(start);
  for (const Cell cell : found->cells) points.push_back(center_of(cell));
  points.push_back(goal);
  Plan plan{.path = {}, .expanded = found->expanded};
  if (!stands_clear) plan.path.waypoints_m.push_back(start_m);
  for (const Vec2& point :
       shortened(points, map_, *space_, costs_, options_.turn_cost_m / map_.resolution_m)) {
    plan.path.waypoints_m.push_back(in_map(point));
  }
  plan.path.waypoints_m.front() = start_m;  // to the last bit what was asked for
  plan.path.waypoints_m.back() = goal_m;
  return plan;
}

}  // namespace lodestar
