#include "planning/margin_planner.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace lodestar {

MarginPlanner::MarginPlanner(const OccupancyMap& map, const GridPlannerOptions& options,
                             std::span<const double> margins_m)
    : MarginPlanner(std::make_shared<const ObstacleField>(map), options, margins_m) {}

MarginPlanner::MarginPlanner(std::shared_ptr<const ObstacleField> field, const GridPlannerOptions& options,
                             std::span<const double> margins_m)
    : field_(std::move(field)), map_(field_->map()), options_(options) {
  if (!options.footprint)
    for (const double margin_m : margins_m) levels_.push_back({margin_m, nullptr});
  if (levels_.empty()) levels_.emplace_back();
}

const GridPlanner& MarginPlanner::at(std::size_t level) const {
  Level& wanted = levels_[level];
  if (!wanted.planner) {
    GridPlannerOptions options = options_;
    options.radius_m += wanted.margin_m;
    wanted.planner = std::make_unique<const GridPlanner>(field_, options);
  }
  return *wanted.planner;
}

PlanResult MarginPlanner::plan(const Vec2& start_m, const Vec2& goal_m, const PlanHeadings& headings) const {
  const Vec2 end_m = goal_with_margin(goal_m);
  PlanResult shortest = narrowest().plan(start_m, end_m, headings);
  if (levels_.size() == 1 || std::holds_alternative<PlanFailure>(shortest)) return shortest;
  const double longest_m = (1.0 + detour_share) * length_m(std::get<Plan>(shortest).path) + detour_m;
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level) {
    PlanResult result = plan_at(level, start_m, end_m, headings);
    const auto* plan = std::get_if<Plan>(&result);
    if (plan != nullptr && length_m(plan->path) <= longest_m) return result;
  }
  return shortest;
}

bool MarginPlanner::is_clear(const Vec2& from_m, const Vec2& to_m) const {
  return narrowest().is_clear(from_m, to_m);
}

std::optional<Vec2> MarginPlanner::nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const {
  return narrowest().nearest_reachable(start_m, goal_m);
}

Vec2 MarginPlanner::goal_with_margin(const Vec2& goal_m) const {
  if (!goal_m.allFinite() || narrowest().is_clear(goal_m, goal_m)) return goal_m;
  constexpr double spacing_m = 0.001;
  const int reach = static_cast<int>(options_.goal_slack_m / spacing_m);
  std::optional<Vec2> nearest;
  double least_m = options_.goal_slack_m + 1e-9;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vec2 aside_m = spacing_m * Vec2(x, y);
      if (aside_m.norm() >= least_m || !narrowest().is_clear(goal_m + aside_m, goal_m + aside_m)) continue;
      least_m = aside_m.norm();
      nearest = goal_m + aside_m;
    }
  }
  return nearest.value_or(goal_m);
}

/// The point itself, or the nearest cell centre that is clear with the level's margin and reached from the
/// point by a leg that is clear with the narrowest.
std::optional<Vec2> MarginPlanner::roomy_place_near(const Vec2& point_m, std::size_t level) const {
  const GridPlanner& roomy = at(level);
  if (roomy.is_clear(point_m, point_m)) return point_m;
  if (!map_.contains(map_.cell_at(point_m)) || !narrowest().is_clear(point_m, point_m)) return std::nullopt;
  const Cell middle = map_.cell_at(point_m);
  const int reach = 2 + static_cast<int>(std::ceil(levels_[level].margin_m / map_.resolution_m));
  std::optional<Vec2> nearest;
  double least_m = std::numeric_limits<double>::infinity();
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      const Vec2 place_m = map_.center_of({column, row});
      const double away_m = (place_m - point_m).norm();
      if (away_m >= least_m || !roomy.is_clear(place_m, place_m) || !narrowest().is_clear(point_m, place_m)) {
        continue;
      }
      least_m = away_m;
      nearest = place_m;
    }
  }
  return nearest;
}

PlanResult MarginPlanner::plan_at(std::size_t level, const Vec2& start_m, const Vec2& goal_m,
                                  const PlanHeadings& headings) const {
  if (!start_m.allFinite() || !goal_m.allFinite()) return at(level).plan(start_m, goal_m, headings);
  const Vec2 first_m = roomy_place_near(start_m, level).value_or(start_m);
  const Vec2 last_m = roomy_place_near(goal_m, level).value_or(goal_m);
  PlanHeadings between = headings;
  if (first_m != start_m) between.start_rad.reset();
  if (last_m != goal_m) between.goal_rad.reset();
  PlanResult result = at(level).plan(first_m, last_m, between);
  if (auto* plan = std::get_if<Plan>(&result)) {
    std::vector<Vec2>& waypoints_m = plan->path.waypoints_m;
    if (first_m != start_m) waypoints_m.insert(waypoints_m.begin(), start_m);
    if (last_m != goal_m) waypoints_m.push_back(goal_m);
  }
  return result;
}

}  // namespace lodestar
