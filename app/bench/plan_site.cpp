#include "app/bench/plan_site.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "app/bench/plan_queries.hpp"
#include "app/common/stopwatch.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "maps/median.hpp"
#include "planning/jump_search.hpp"

namespace lodestar {
namespace {

struct Answer {
  double microseconds = 0.0;
  std::optional<Path> path;
};

Answer answer(const GridPlanner& planner, const PlanQuery& query) {
  PlanResult result = PlanFailure::no_path;
  Answer answer;
  answer.microseconds = microseconds_of([&] { result = planner.plan(query.start_m, query.goal_m); });
  if (auto* plan = std::get_if<Plan>(&result)) answer.path = std::move(plan->path);
  return answer;
}

/// All measurements of one planner, before medians are taken.
struct Collected {
  std::vector<double> microseconds;
  std::vector<double> length_ratios;
  std::vector<double> time_ratios;
  std::vector<double> turns;
};

double travel_s(const Path& path, const MotionLimits& limits) {
  return travel_time_s(path, std::nullopt, std::nullopt, limits);
}

/// Ratios to the best of all answers to the same query.
void collect(const std::vector<Answer>& answers, const MotionLimits& limits,
             std::vector<Collected>& collected) {
  double shortest_m = std::numeric_limits<double>::infinity();
  double fastest_s = shortest_m;
  for (const Answer& each : answers) {
    if (!each.path) continue;
    shortest_m = std::min(shortest_m, length_m(*each.path));
    fastest_s = std::min(fastest_s, travel_s(*each.path, limits));
  }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    collected[i].microseconds.push_back(answers[i].microseconds);
    if (!answers[i].path) continue;
    collected[i].length_ratios.push_back(length_m(*answers[i].path) / shortest_m);
    collected[i].time_ratios.push_back(travel_s(*answers[i].path, limits) / fastest_s);
    collected[i].turns.push_back(static_cast<double>(answers[i].path->waypoints_m.size()) - 2.0);
  }
}

PlannerResult summary_of(PlannerKind kind, const Collected& collected) {
  PlannerResult result{.kind = kind, .found = static_cast<int>(collected.length_ratios.size())};
  result.microseconds = median(collected.microseconds);
  if (result.found == 0) return result;
  result.length_ratio = median(collected.length_ratios);
  result.worst_length_ratio = std::ranges::max(collected.length_ratios);
  result.travel_time_ratio = median(collected.time_ratios);
  result.mean_turns = 0.0;
  for (const double turns : collected.turns) result.mean_turns += turns / result.found;
  return result;
}

}  // namespace

SiteBenchResult bench_site(const Site& site, const SiteBenchOptions& options) {
  const OccupancyMap& map = site.map.map;
  GridPlannerOptions planning = navigation_options(site.robot).planner;
  planning.clearance_weight = 0.0;  // so that lengths can be compared
  planning.sampling = options.sampling;

  const CollisionChecker space(map, planning.radius_m);
  const JumpTable jumps(space);
  JumpSearch grid(jumps);
  std::vector<std::unique_ptr<GridPlanner>> planners;
  for (const PlannerKind kind : options.kinds) {
    planning.kind = kind;
    planners.push_back(std::make_unique<GridPlanner>(map, planning));
  }

  const std::vector<PlanQuery> queries =
      random_queries(space, options.queries, options.least_distance_m, options.seed);
  std::vector<Collected> collected(planners.size());
  std::vector<double> grid_times;
  for (const PlanQuery& query : queries) {
    const Cell start = map.cell_at(query.start_m);
    const Cell goal = map.cell_at(query.goal_m);
    grid_times.push_back(microseconds_of([&] { (void)grid.find(start, goal); }));
  }
  for (const PlanQuery& query : queries) {
    std::vector<Answer> answers;
    for (const auto& planner : planners) answers.push_back(answer(*planner, query));
    collect(answers, planning.limits, collected);
  }

  SiteBenchResult result{.queries = static_cast<int>(queries.size()),
                         .grid_microseconds = median(grid_times)};
  for (std::size_t i = 0; i < planners.size(); ++i) {
    result.planners.push_back(summary_of(options.kinds[i], collected[i]));
  }
  return result;
}

}  // namespace lodestar
