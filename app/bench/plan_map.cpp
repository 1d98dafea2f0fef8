#include "app/bench/plan_map.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <sys/resource.h>

#include "app/common/stopwatch.hpp"

namespace lodestar {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in KiB
}

/// The map with a box of half a metre in its middle.
OccupancyMap with_box(OccupancyMap map) {
  const int half = std::max(1, static_cast<int>(0.25 / map.resolution_m));
  const Cell middle{map.columns / 2, map.rows / 2};
  for (int row = middle.row - half; row <= middle.row + half; ++row)
    for (int column = middle.column - half; column <= middle.column + half; ++column)
      if (map.contains({column, row})) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  return map;
}

MapBenchAnswer answer(const GridPlanner& planner, const PlanQuery& query, const MotionLimits& limits) {
  PlanResult result = PlanFailure::no_path;
  MapBenchAnswer answer{.query = query};
  answer.microseconds = microseconds_of([&] { result = planner.plan(query.start_m, query.goal_m); });
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return answer;
  answer.found = true;
  answer.travel_time_s = travel_time_s(plan->path, std::nullopt, std::nullopt, limits);
  answer.best_s = answer.travel_time_s;
  answer.expanded = plan->expanded;
  return answer;
}

}  // namespace

MapBenchResult bench_map(const OccupancyMap& map, const MapBenchOptions& options) {
  const auto prepared = [](const OccupancyMap& of, const GridPlannerOptions& planner) {
    return std::make_unique<const GridPlanner>(of, planner);
  };
  const std::vector<PlanQuery> queries = [&] {
    const CollisionChecker space(map, options.planner.radius_m);
    return random_queries(space, options.queries, options.least_distance_m, options.seed);
  }();
  MapBenchResult result;
  std::unique_ptr<const GridPlanner> planner;
  result.prepare_us = microseconds_of([&] { planner = prepared(map, options.planner); });
  for (const PlanQuery& query : queries)
    result.answers.push_back(answer(*planner, query, options.planner.limits));
  result.peak_memory_mb = peak_memory_mb();
  planner.reset();
  {
    const OccupancyMap changed = with_box(map);
    result.prepare_again_us = microseconds_of([&] { planner = prepared(changed, options.planner); });
    planner.reset();
  }
  for (const GridPlannerOptions& reference : options.references) {
    planner = prepared(map, reference);
    for (MapBenchAnswer& each : result.answers) {
      const MapBenchAnswer other = answer(*planner, each.query, options.planner.limits);
      if (each.found && other.found) each.best_s = std::min(each.best_s, other.travel_time_s);
    }
  }
  return result;
}

}  // namespace lodestar
