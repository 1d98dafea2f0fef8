#include "planning/grid_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "planning/collision_checker.hpp"
#include "planning/corners.hpp"
#include "planning/fastest_path.hpp"
#include "planning/footprint_planner.hpp"
#include "planning/grid_search.hpp"
#include "planning/jump_search.hpp"
#include "planning/path_shortening.hpp"
#include "planning/visibility_graph_search.hpp"

namespace lodestar {
namespace {

/// A leg out of a tight start need not be clear for the disc; its line must not cross an obstacle.
bool leads_over_drivable(const OccupancyMap& map, const Vec2& from, const Vec2& to) {
  constexpr double spacing_cells = 0.05;
  const int samples = 1 + static_cast<int>((to - from).norm() / spacing_cells);
  for (int i = 0; i <= samples; ++i) {
    const Cell cell = cell_at(from + (to - from) * (static_cast<double>(i) / samples));
    if (!map.contains(cell) || !is_drivable(map.at(cell))) return false;
  }
  return true;
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
    case PlanFailure::line_blocked:
      return "the straight line to the goal is blocked";
    case PlanFailure::unsure:
      return "no path on which the pose stays sure enough";
    case PlanFailure::limit_reached:
      return "no path found within the limits";
  }
  return "";
}

/// The data precomputed from a map, and the memory of the searches.
struct GridPlanner::Searches {
  Searches(std::shared_ptr<const ObstacleField> field, double radius_m) : space(std::move(field), radius_m) {}

  [[nodiscard]] JumpPath shortest_path(Cell first, Cell last) {
    return (by_table ? by_table->find(first, last) : by_scan->find(first, last)).value();
  }

  CollisionChecker space;
  std::optional<JumpTable> table;
  std::optional<JumpScan> scan;
  std::optional<JumpSearch<JumpTable>> by_table;  ///< on the grid, for `astar`
  std::optional<JumpSearch<JumpScan>> by_scan;    ///< on the grid, as the first answer of all others
  std::optional<GridSearch> cheapest;             ///< on the grid, when cells cost differently
  std::optional<VisibilityGraphSearch> turns;
  std::optional<UncertaintyConstrainedPlanner> constrained;
};

GridPlanner::GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options)
    : GridPlanner(std::make_shared<const ObstacleField>(map), options) {}

GridPlanner::GridPlanner(std::shared_ptr<const ObstacleField> field, const GridPlannerOptions& options)
    : field_(std::move(field)),
      map_(field_->map()),
      options_(options),
      searches_(std::make_unique<Searches>(field_, options.radius_m)) {
  if (options_.footprint) {
    outline_ = std::make_unique<FootprintPlanner>(map_, *options_.footprint, options_);
    return;
  }
  weigh_cells();
  prepare_searches();
}

GridPlanner::~GridPlanner() = default;

void GridPlanner::prepare_searches() {
  Searches& searches = *searches_;
  if (options_.uncertainty_constraint)
    searches.constrained.emplace(searches.space, costs_, *options_.uncertainty_constraint);
  if (sampling_method(options_.kind)) return;
  if (costs_.empty() && options_.kind == PlannerKind::astar) {
    searches.table.emplace(searches.space);
    searches.by_table.emplace(*searches.table);
  } else {
    searches.scan.emplace(searches.space);
    searches.by_scan.emplace(*searches.scan);
  }
  if (!costs_.empty()) searches.cheapest.emplace(searches.space, costs_);
  if (options_.kind == PlannerKind::astar) return;
  std::vector<TurnPoint> points = turn_points(searches.space, searches.space.radius_cells());
  if (!costs_.empty()) {
    const double away_cells = (options_.radius_m + options_.preferred_clearance_m) / map_.resolution_m;
    std::ranges::copy(turn_points(searches.space, away_cells), std::back_inserter(points));
  }
  searches.turns.emplace(searches.space, std::move(points), options_.turn_search);
}

Vec2 GridPlanner::in_grid(const Vec2& point_m) const {
  return inverse(map_.map_from_grid) * point_m / map_.resolution_m;
}

Vec2 GridPlanner::in_map(const Vec2& point_in_grid) const {
  return map_.map_from_grid * (point_in_grid * map_.resolution_m);
}

bool GridPlanner::is_clear(const Vec2& from_m, const Vec2& to_m) const {
  if (outline_) return outline_->is_clear(from_m, to_m);
  return searches_->space.along(in_grid(from_m), in_grid(to_m));
}

/// The nearest clear cell whose centre can be reached straight from the point.
std::optional<Cell> GridPlanner::clear_cell_near(const Vec2& point_in_grid) const {
  const Cell middle = cell_at(point_in_grid);
  std::optional<Cell> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int row = middle.row - 1; row <= middle.row + 1; ++row) {
    for (int column = middle.column - 1; column <= middle.column + 1; ++column) {
      const Cell cell{column, row};
      const double distance = (center_of(cell) - point_in_grid).squaredNorm();
      if (distance >= least || !searches_->space.at(cell) ||
          !searches_->space.along(point_in_grid, center_of(cell)))
        continue;
      least = distance;
      nearest = cell;
    }
  }
  return nearest;
}

/// From a start too near to an obstacle: the nearest clear cell within about the radius that a straight line
/// over drivable cells reaches.
std::optional<Cell> GridPlanner::way_out(const Vec2& start_in_grid) const {
  const Cell start = cell_at(start_in_grid);
  const int reach = 1 + static_cast<int>(std::ceil(options_.radius_m / map_.resolution_m));
  std::optional<Cell> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int row = start.row - reach; row <= start.row + reach; ++row) {
    for (int column = start.column - reach; column <= start.column + reach; ++column) {
      const Cell cell{column, row};
      const double distance = (center_of(cell) - start_in_grid).squaredNorm();
      if (distance >= least || !searches_->space.at(cell) ||
          !leads_over_drivable(map_, start_in_grid, center_of(cell)))
        continue;
      least = distance;
      nearest = cell;
    }
  }
  return nearest;
}

std::optional<Cell> GridPlanner::first_cell(const Vec2& start) const {
  return searches_->space.along(start, start) ? clear_cell_near(start) : way_out(start);
}

std::variant<GridPlanner::Ends, PlanFailure> GridPlanner::ends_of(const Vec2& start_m,
                                                                  const Vec2& goal_m) const {
  const Vec2 start = in_grid(start_m);
  const Vec2 goal = in_grid(goal_m);
  const CollisionChecker& space = searches_->space;
  if (!start.allFinite() || !map_.contains(map_.cell_at(start_m))) return PlanFailure::start_outside_map;
  if (!goal.allFinite() || !map_.contains(map_.cell_at(goal_m))) return PlanFailure::goal_outside_map;
  if (!is_drivable(map_.at(cell_at(start)))) return PlanFailure::start_occupied;
  if (!space.along(goal, goal)) return PlanFailure::goal_occupied;

  const bool starts_clear = space.along(start, start);
  const std::optional<Cell> first = first_cell(start);
  const std::optional<Cell> last = clear_cell_near(goal);
  if (!first) return starts_clear ? PlanFailure::no_path : PlanFailure::start_occupied;
  if (!last || space.region(*first) != space.region(*last)) return PlanFailure::no_path;
  return Ends{start, goal, *first, *last, starts_clear};
}

PlanResult GridPlanner::plan(const Vec2& start_m, const Vec2& goal_m, const PlanHeadings& headings) const {
  if (outline_) return outline_->plan(start_m, goal_m, headings);
  const std::variant<Ends, PlanFailure> checked = ends_of(start_m, goal_m);
  if (const auto* failure = std::get_if<PlanFailure>(&checked)) return *failure;
  const Ends& ends = std::get<Ends>(checked);
  Plan plan;
  if (!ends.starts_clear) plan.path.waypoints_m.push_back(start_m);
  std::optional<std::vector<Vec2>> points = legs_between(ends, headings, plan.expanded);
  if (!points) return PlanFailure::limit_reached;
  if (searches_->constrained && !searches_->constrained->holds(*points))
    points = legs_within_constraint(ends, plan.expanded);
  if (!points) return PlanFailure::unsure;
  for (const Vec2& point : *points) plan.path.waypoints_m.push_back(in_map(point));
  plan.path.waypoints_m.front() = start_m;  // bit-exact, without the rounding of in_map()
  plan.path.waypoints_m.back() = goal_m;
  return plan;
}

/// Plans by the chosen method; nothing only when a sampling planner gives up.
std::optional<std::vector<Vec2>> GridPlanner::legs_between(const Ends& ends, const PlanHeadings& headings,
                                                           std::size_t& expanded) const {
  if (sampling_method(options_.kind)) return sampled_legs(ends, expanded);
  if (options_.kind == PlannerKind::astar) return few_legs(ends, expanded);
  return cheapest_legs(ends, headings, expanded);
}

std::vector<Vec2> GridPlanner::points_over(std::span<const Cell> cells, const Ends& ends) {
  std::vector<Vec2> points;
  if (ends.starts_clear) points.push_back(ends.start);
  for (const Cell cell : cells) points.push_back(center_of(cell));
  points.push_back(ends.goal);
  return points;
}

/// The shortest grid path from start to goal. It exists, as both are in the same region.
std::vector<Vec2> GridPlanner::jump_path(const Ends& ends, std::size_t& expanded) const {
  const JumpPath found = searches_->shortest_path(ends.first, ends.last);
  expanded += found.expanded;
  return points_over(found.turns, ends);
}

std::optional<std::vector<Vec2>> GridPlanner::legs_within_constraint(const Ends& ends,
                                                                     std::size_t& expanded) const {
  const Vec2 start = ends.starts_clear ? ends.start : center_of(ends.first);
  const std::optional<GridPath> found = searches_->constrained->find(start, ends.first, ends.last, ends.goal);
  if (!found) return std::nullopt;
  expanded += found->expanded;
  return searches_->constrained->shortened(points_over(found->cells, ends), options_.turn_cost_m);
}

std::vector<Vec2> GridPlanner::few_legs(const Ends& ends, std::size_t& expanded) const {
  const std::vector<Vec2> points = costs_.empty() ? jump_path(ends, expanded) : cheapest_path(ends, expanded);
  const PathCost cost(map_, costs_, std::nullopt);
  return shortened(points, searches_->space, cost, options_.turn_cost_m);
}

/// Over cells that cost differently; for `fastest` and `anyangle`, the shortest when that search is too long.
std::vector<Vec2> GridPlanner::cheapest_path(const Ends& ends, std::size_t& expanded) const {
  const bool is_answer = options_.kind == PlannerKind::astar;
  const std::size_t most = is_answer ? GridSearch::unlimited : options_.turn_search.cells;
  const std::optional<GridPath> found = searches_->cheapest->find(ends.first, ends.last, most);
  expanded += searches_->cheapest->expanded();
  return found ? points_over(found->cells, ends) : jump_path(ends, expanded);
}

std::vector<Vec2> GridPlanner::cheapest_legs(const Ends& ends, const PlanHeadings& headings,
                                             std::size_t& expanded) const {
  const bool timed = options_.kind == PlannerKind::fastest;
  const PathCost cost(map_, costs_, timed ? std::optional(options_.limits) : std::nullopt);
  EndHeadings in_grid_frame;
  const double yaw_rad = map_.map_from_grid.yaw_rad;
  if (headings.start_rad && ends.starts_clear)
    in_grid_frame.start_rad = wrap_angle(*headings.start_rad - yaw_rad);
  if (headings.goal_rad) in_grid_frame.goal_rad = wrap_angle(*headings.goal_rad - yaw_rad);

  const CollisionChecker& space = searches_->space;
  std::vector<Vec2> known =
      costs_.empty() ? pulled_tight(jump_path(ends, expanded), space) : few_legs(ends, expanded);
  // Moving turns saves much time, but hardly any length: for that, turn points are nearly optimal.
  VisibilityGraphSearch& turns = *searches_->turns;
  TurnPath found =
      timed ? fastest_path(std::move(known), in_grid_frame, space, cost, turns, options_.turn_search)
            : turns.find(known, in_grid_frame, cost);
  expanded += found.expanded;
  return std::move(found.points);
}

std::optional<std::vector<Vec2>> GridPlanner::sampled_legs(const Ends& ends, std::size_t& expanded) const {
  const CollisionChecker& space = searches_->space;
  const std::optional<SampledPath> found = search_by_sampling(
      sampling_method(options_.kind).value(), space, ends.starts_clear ? ends.start : center_of(ends.first),
      ends.goal, options_.sampling);
  if (!found) return std::nullopt;
  expanded += found->iterations;
  return shortened(found->points, space, PathCost(map_, costs_, std::nullopt), options_.turn_cost_m);
}

std::optional<Vec2> GridPlanner::nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const {
  if (outline_) return outline_->nearest_reachable(start_m, goal_m);
  const Vec2 start = in_grid(start_m);
  if (!start.allFinite() || !goal_m.allFinite() || !map_.contains(map_.cell_at(start_m))) return std::nullopt;
  const CollisionChecker& space = searches_->space;
  const std::optional<Cell> first = first_cell(start);
  if (!first) return std::nullopt;
  std::optional<Vec2> nearest;
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      if (space.region({column, row}) != space.region(*first)) continue;
      const Vec2 center = map_.center_of({column, row});
      if (!nearest || (center - goal_m).squaredNorm() < (*nearest - goal_m).squaredNorm()) nearest = center;
    }
  }
  return nearest;
}

}  // namespace lodestar
