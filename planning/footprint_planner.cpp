#include "planning/footprint_planner.hpp"

#include <cmath>
#include <numbers>

namespace lodestar {
namespace {

GridPlannerOptions for_disc(GridPlannerOptions options, double radius_m) {
  options.footprint.reset();
  options.radius_m = radius_m;
  if (sampling_method(options.kind)) options.kind = PlannerKind::astar;  // only to tell whether a path exists
  return options;
}

/// Is the footprint clear in the given heading, or else in any of 32?
bool fits(const FootprintCollisionChecker& space, const Vec2& point, std::optional<double> heading_rad) {
  if (heading_rad) return space.at(point, *heading_rad);
  constexpr int tried = 32;
  for (int i = 0; i < tried; ++i) {
    if (space.at(point, wrap_angle(2.0 * std::numbers::pi * i / tried))) return true;
  }
  return false;
}

}  // namespace

struct FootprintPlanner::Query {
  Vec2 start_m;
  Vec2 goal_m;
  PlanHeadings headings_in_map;
  Vec2 start;
  Vec2 goal;
  EndHeadings headings;
};

FootprintPlanner::FootprintPlanner(const OccupancyMap& map, const Footprint& footprint,
                                   const GridPlannerOptions& options)
    : map_(map),
      options_(options),
      space_(map, footprint),
      inner_(map, for_disc(options, footprint.inner_radius_m())),
      outer_(map, for_disc(options, footprint.outer_radius_m())),
      search_(std::make_unique<FootprintSearch>(space_, options.limits)) {
  if (options.uncertainty_constraint)
    constrained_.emplace(space_.inner(), even_, *options.uncertainty_constraint);
}

PlanResult FootprintPlanner::plan(const Vec2& start_m, const Vec2& goal_m,
                                  const PlanHeadings& headings) const {
  const PlanResult lower = inner_.plan(start_m, goal_m, headings);
  if (const auto* failure = std::get_if<PlanFailure>(&lower)) return *failure;
  Query query{.start_m = start_m, .goal_m = goal_m, .headings_in_map = headings};
  const Pose2 grid_from_map = inverse(map_.map_from_grid);
  query.start = grid_from_map * start_m / map_.resolution_m;
  query.goal = grid_from_map * goal_m / map_.resolution_m;
  if (headings.start_rad) query.headings.start_rad = wrap_angle(*headings.start_rad + grid_from_map.yaw_rad);
  if (headings.goal_rad) query.headings.goal_rad = wrap_angle(*headings.goal_rad + grid_from_map.yaw_rad);

  if (const std::optional<PlanFailure> failure = fits_at_ends(query)) return *failure;
  if (sampling_method(options_.kind)) return sampled(query);
  if (const std::optional<Plan> plan = fitting(lower, query)) return *plan;
  const std::optional<Plan> upper = fitting(outer_.plan(start_m, goal_m, headings), query);
  constexpr double hardly_longer = 1.02;
  if (upper && time_s(*upper, query) <= hardly_longer * time_s(std::get<Plan>(lower), query)) return *upper;
  PlanResult between = searched(query);
  const auto* plan = std::get_if<Plan>(&between);
  return upper && (plan == nullptr || time_s(*upper, query) < time_s(*plan, query)) ? *upper : between;
}

std::optional<PlanFailure> FootprintPlanner::fits_at_ends(const Query& query) const {
  if (!fits(space_, query.start, query.headings.start_rad)) return PlanFailure::start_occupied;
  if (!fits(space_, query.goal, query.headings.goal_rad)) return PlanFailure::goal_occupied;
  return std::nullopt;
}

std::optional<Plan> FootprintPlanner::fitting(const PlanResult& result, const Query& query) const {
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return std::nullopt;
  std::vector<Vec2> points;
  for (const Vec2& point_m : plan->path.waypoints_m)
    points.emplace_back(inverse(map_.map_from_grid) * point_m / map_.resolution_m);
  if (!space_.along(points, query.headings)) return std::nullopt;
  return *plan;
}

PlanResult FootprintPlanner::searched(const Query& query) const {
  const std::optional<FootprintPath> found = search_->find(query.start, query.goal, query.headings);
  if (!found) return PlanFailure::no_path;
  return plan_over(found->points, found->expanded, query);
}

PlanResult FootprintPlanner::sampled(const Query& query) const {
  const std::optional<SampledPath> found =
      search_by_sampling(sampling_method(options_.kind).value(), space_, query.start, query.goal,
                         query.headings, options_.sampling);
  if (!found) return PlanFailure::limit_reached;
  return plan_over(found->points, found->iterations, query);
}

/// Removes points only while the uncertainty constraint still holds.
PlanResult FootprintPlanner::plan_over(std::vector<Vec2> points, std::size_t expanded,
                                       const Query& query) const {
  std::vector<Vec2> few = space_.with_fewer_legs(points, query.headings);
  if (constrained_ && !constrained_->holds(few)) few = std::move(points);
  if (constrained_ && !constrained_->holds(few)) return PlanFailure::unsure;
  Plan plan{.path = {}, .expanded = expanded};
  for (const Vec2& point : few)
    plan.path.waypoints_m.emplace_back(map_.map_from_grid * Vec2(point * map_.resolution_m));
  plan.path.waypoints_m.front() = query.start_m;
  plan.path.waypoints_m.back() = query.goal_m;
  return plan;
}

double FootprintPlanner::time_s(const Plan& plan, const Query& query) const {
  return travel_time_s(plan.path, query.headings_in_map.start_rad, query.headings_in_map.goal_rad,
                       options_.limits);
}

bool FootprintPlanner::is_clear(const Vec2& from_m, const Vec2& to_m) const {
  return space_.footprint().is_clear_driving(map_, {from_m, heading_between(from_m, to_m)}, to_m);
}

/// Where the outer disc is clear, the robot can turn to any heading.
std::optional<Vec2> FootprintPlanner::nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const {
  return outer_.nearest_reachable(start_m, goal_m);
}

}  // namespace lodestar
