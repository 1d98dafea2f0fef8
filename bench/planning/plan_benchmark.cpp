#include <benchmark/benchmark.h>
#include <optional>

#include "maps/map_file.hpp"
#include "maps/random.hpp"
#include "planning/collision_checker.hpp"
#include "planning/grid_planner.hpp"
#include "planning/grid_search.hpp"
#include "planning/jump_search.hpp"

// Queries between random clear points of the lab (306 x 150 cells), and the preprocessing of a map.
namespace lodestar {
namespace {

constexpr double radius_m = 0.25;

const OccupancyMap& lab() {
  static const OccupancyMap map = load_map(LODESTAR_SOURCE_DIR "/sites/lab/map.yaml").map;
  return map;
}

const CollisionChecker& lab_space() {
  static const CollisionChecker space(lab(), radius_m);
  return space;
}

struct Query {
  Cell start;
  Cell goal;
};

/// The same queries for every benchmark.
const std::vector<Query>& queries() {
  static const std::vector<Query> all = [] {
    constexpr std::size_t count = 512;
    Random random(1);
    const auto cell = [&random] {
      return Cell{static_cast<int>(random.below(static_cast<std::uint64_t>(lab().columns))),
                  static_cast<int>(random.below(static_cast<std::uint64_t>(lab().rows)))};
    };
    std::vector<Query> found;
    while (found.size() < count) {
      const Query query{cell(), cell()};
      const bool clear = lab_space().at(query.start) && lab_space().at(query.goal);
      if (clear && lab_space().region(query.start) == lab_space().region(query.goal)) found.push_back(query);
    }
    return found;
  }();
  return all;
}

template <typename Ask>
void ask_all(benchmark::State& state, Ask ask) {
  std::size_t next = 0;
  for (auto _ : state) ask(queries()[next++ % queries().size()]);
}

template <typename Jumps>
void jump_search(benchmark::State& state) {
  const Jumps jumps(lab_space());
  JumpSearch<Jumps> search(jumps);
  ask_all(state, [&](const Query& query) { benchmark::DoNotOptimize(search.find(query.start, query.goal)); });
}
BENCHMARK(jump_search<JumpTable>)->Unit(benchmark::kMicrosecond);
BENCHMARK(jump_search<JumpScan>)->Unit(benchmark::kMicrosecond);

void plain_astar(benchmark::State& state) {
  const CellCosts even(lab().cells.size(), 1.0F);
  GridSearch search(lab_space(), even);
  ask_all(state, [&](const Query& query) { benchmark::DoNotOptimize(search.find(query.start, query.goal)); });
}
BENCHMARK(plain_astar)->Unit(benchmark::kMicrosecond);

void whole_plan(benchmark::State& state, PlannerKind kind, double clearance_weight) {
  const GridPlanner planner(lab(),
                            {.kind = kind, .radius_m = radius_m, .clearance_weight = clearance_weight});
  ask_all(state, [&](const Query& query) {
    benchmark::DoNotOptimize(planner.plan(lab().center_of(query.start), lab().center_of(query.goal)));
  });
}
BENCHMARK_CAPTURE(whole_plan, astar, PlannerKind::astar, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole_plan, astar_with_clearance, PlannerKind::astar, 1.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole_plan, anyangle, PlannerKind::anyangle, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole_plan, fastest, PlannerKind::fastest, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(whole_plan, fastest_with_clearance, PlannerKind::fastest, 1.0)
    ->Unit(benchmark::kMicrosecond);

template <typename Prepared>
void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Prepared(lab_space()));
}
BENCHMARK(prepare<JumpTable>)->Unit(benchmark::kMicrosecond);
BENCHMARK(prepare<JumpScan>)->Unit(benchmark::kMicrosecond);

void prepare_planner(benchmark::State& state) {
  for (auto _ : state) {
    const GridPlanner planner(lab(), {.kind = PlannerKind::fastest, .radius_m = radius_m});
    benchmark::DoNotOptimize(&planner);
  }
}
BENCHMARK(prepare_planner)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
