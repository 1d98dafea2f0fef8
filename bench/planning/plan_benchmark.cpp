#include <benchmark/benchmark.h>

#include "maps/map_file.hpp"
#include "planning/grid_planner.hpp"

// One query from S to E through the lab (306 x 150 cells), and what the planner prepares once for a map.
namespace lodestar {
namespace {

const OccupancyMap& lab() {
  static const OccupancyMap map = load_map(LODESTAR_SOURCE_DIR "/sites/lab/map.yaml").map;
  return map;
}

void plan_through_the_lab(benchmark::State& state) {
  GridPlannerOptions options;
  options.clearance_weight = static_cast<double>(state.range(0));
  const GridPlanner planner(lab(), options);
  for (auto _ : state) benchmark::DoNotOptimize(planner.plan({1.2, 5.6}, {13.9, 2.0}));
}
BENCHMARK(plan_through_the_lab)->ArgName("clearance_weight")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void prepare_the_lab(benchmark::State& state) {
  for (auto _ : state) {
    const GridPlanner planner(lab());
    benchmark::DoNotOptimize(&planner);
  }
}
BENCHMARK(prepare_the_lab)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
