#include "app/commands/bench_plan_map.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "app/bench/plan_beside.hpp"
#include "app/bench/plan_maps.hpp"
#include "app/common/json_text.hpp"
#include "maps/map_file.hpp"
#include "maps/percentile.hpp"

namespace lodestar {
namespace {

struct Percentiles {
  double median = 0.0;
  double p90 = 0.0;
  double p99 = 0.0;
  double greatest = 0.0;
};

Percentiles percentiles_of(const std::vector<double>& values) {
  const auto at = [&](double fraction) { return percentile(values, fraction).value_or(0.0); };
  return {at(0.5), at(0.9), at(0.99), at(1.0)};
}

nlohmann::ordered_json as_json(const Percentiles& of) {
  return {{"median", of.median}, {"p90", of.p90}, {"p99", of.p99}, {"max", of.greatest}};
}

struct Summary {
  int found = 0;
  Percentiles plan_us;
  Percentiles travel_time_ratio;
};

Summary summary_of(const MapBenchResult& result) {
  std::vector<double> microseconds;
  std::vector<double> ratios;
  for (const MapBenchAnswer& each : result.answers) {
    microseconds.push_back(each.microseconds);
    if (each.found) ratios.push_back(each.best_s > 0.0 ? each.travel_time_s / each.best_s : 1.0);
  }
  return {static_cast<int>(ratios.size()), percentiles_of(microseconds), percentiles_of(ratios)};
}

nlohmann::ordered_json as_json(const MapBenchAnswer& each) {
  const Vec2& start = each.query.start_m;
  const Vec2& goal = each.query.goal_m;
  return {{"start", {start.x(), start.y()}},
          {"goal", {goal.x(), goal.y()}},
          {"found", each.found},
          {"plan_us", each.microseconds},
          {"expanded", each.expanded},
          {"travel_time_s", each.travel_time_s},
          {"best_s", each.best_s}};
}

void print_json(const MapBenchResult& result, const Summary& summary, const OccupancyMap& map,
                const MapBenchOptions& options) {
  auto answers = nlohmann::ordered_json::array();
  for (const MapBenchAnswer& each : result.answers) answers.push_back(as_json(each));
  const nlohmann::ordered_json json{{"seed", options.seed},
                                    {"planner", to_string(options.planner.kind)},
                                    {"columns", map.columns},
                                    {"rows", map.rows},
                                    {"resolution_m", map.resolution_m},
                                    {"queries", result.answers.size()},
                                    {"found", summary.found},
                                    {"prepare_us", result.prepare_us},
                                    {"prepare_after_change_us", result.prepare_again_us},
                                    {"plan_us", as_json(summary.plan_us)},
                                    {"travel_time_ratio", as_json(summary.travel_time_ratio)},
                                    {"peak_memory_mb", result.peak_memory_mb},
                                    {"answers", answers}};
  fmt::print("{}", json_document(json));
}

void print_table(const MapBenchResult& result, const Summary& summary, const OccupancyMap& map,
                 const MapBenchOptions& options) {
  fmt::print("seed {}: {} x {} cells of {} m, radius {} m, {}: {} of {} queries found\n", options.seed,
             map.columns, map.rows, map.resolution_m, options.planner.radius_m,
             to_string(options.planner.kind), summary.found, result.answers.size());
  fmt::print("prepared in {:.1f} ms, after a local change in {:.1f} ms; peak memory {:.0f} MB\n",
             1e-3 * result.prepare_us, 1e-3 * result.prepare_again_us, result.peak_memory_mb);
  fmt::print("                      median     90 %     99 %      max\n");
  const auto row = [](const char* name, const Percentiles& of, double scale) {
    fmt::print("{:<18} {:>9.3f} {:>8.3f} {:>8.3f} {:>8.3f}\n", name, scale * of.median, scale * of.p90,
               scale * of.p99, scale * of.greatest);
  };
  row("plan (ms)", summary.plan_us, 1e-3);
  row("travel time ratio", summary.travel_time_ratio, 1.0);
  fmt::print("Travel time as ratio to the best path known for the same query.\n");
}

/// The same planner with far more work, and the others that need no random numbers: their paths count among
/// the best known.
std::vector<GridPlannerOptions> references(const GridPlannerOptions& planner) {
  std::vector<GridPlannerOptions> all;
  for (const PlannerKind kind : {PlannerKind::fastest, PlannerKind::anyangle, PlannerKind::astar}) {
    all.push_back(planner);
    all.back().kind = kind;
  }
  all.front().turn_search = {.complete = 960,
                             .candidates = 1000,
                             .work = 40 * planner.turn_search.work,
                             .work_of_rounds = 40 * planner.turn_search.work};
  return all;
}

void bench_beside(const OccupancyMap& map, const BenchPlanMapArguments& arguments) {
  const MapBenchOptions& options = arguments.bench;
  const std::vector<PlanQuery> queries =
      random_queries(CollisionChecker(map, options.planner.radius_m), options.queries,
                     options.least_distance_m, options.seed);
  const PlanBesideResult result =
      bench_plan_beside(map, options.planner, queries, from_seconds(arguments.beside_s));
  constexpr double wanted_ms = 22.0;
  const auto in_time = std::ranges::count_if(result.period_ms, [&](double ms) { return ms <= wanted_ms; });
  const auto at = [&](double fraction) { return percentile(result.period_ms, fraction).value_or(0.0); };
  fmt::print("{} steps of 20 ms beside {} plans and {} new maps of {} x {} cells\n", result.period_ms.size(),
             result.plans, result.new_maps, map.columns, map.rows);
  fmt::print("period: median {:.2f} ms, 99.9 % {:.2f} ms, max {:.2f} ms; {:.2f} % within {:.0f} ms\n",
             at(0.5), at(0.999), at(1.0),
             100.0 * static_cast<double>(in_time) /
                 static_cast<double>(std::max<std::size_t>(result.period_ms.size(), 1)),
             wanted_ms);
}

}  // namespace

void bench_on_map(BenchPlanMapArguments arguments) {
  MapBenchOptions& options = arguments.bench;
  options.planner.clearance_weight = 0.0;  // as `lodestar plan` does
  options.references = references(options.planner);
  const OccupancyMap map = arguments.generated.empty()
                               ? load_map(arguments.map).map
                               : generated_map(arguments.generated, options.seed).value();
  if (arguments.beside_s > 0.0) return bench_beside(map, arguments);
  const MapBenchResult result = bench_map(map, options);
  const Summary summary = summary_of(result);
  if (arguments.json) {
    print_json(result, summary, map, options);
  } else {
    print_table(result, summary, map, options);
  }
}

}  // namespace lodestar
