#include <benchmark/benchmark.h>
#include <numbers>

#include "drivers/simulation/simulated_scanner.hpp"
#include "maps/map_file.hpp"
#include "maps/ray_casting.hpp"

// Time of one scan of 720 beams in the lab: the bare grid traversal, and the whole simulated scanner with six
// people in view.
namespace lodestar {
namespace {

constexpr int beams = 720;
constexpr double range_m = 12.0;

OccupancyMap lab() {
  return load_map(LODESTAR_SOURCE_DIR "/sites/lab/map.yaml").map;
}

/// Places along the lab's usual drive.
std::vector<Vec2> places() {
  return {{1.2, 5.6}, {4.0, 4.4}, {7.5, 4.0}, {10.0, 3.0}, {13.9, 2.0}};
}

void cast_720_beams(benchmark::State& state) {
  const OccupancyMap map = lab();
  const std::vector<Vec2> from_m = places();
  std::size_t turn = 0;
  for (auto _ : state) {
    const Vec2& at_m = from_m[turn++ % from_m.size()];
    for (int i = 0; i < beams; ++i)
      benchmark::DoNotOptimize(range_to_obstacle_m(map, at_m, 2.0 * std::numbers::pi * i / beams, range_m));
  }
}

void simulate_a_scan(benchmark::State& state) {
  SimulatedScanner scanner(lab(), {}, 1);
  std::vector<DiscState> people;
  for (int i = 0; i < 6; ++i)
    people.push_back({.has_legs = true, .position_m = {2.0 * i + 1.0, 4.5}, .velocity_mps = {1.0, 0.0}});
  int tick = 0;
  for (auto _ : state) {
    for (int i = 0; i < 10; ++i)
      scanner.observe(Stamp(std::chrono::milliseconds(10 * tick++)), {{7.5, 4.0}, 0.01 * tick}, people);
    benchmark::DoNotOptimize(scanner.poll());
  }
}

BENCHMARK(cast_720_beams)->Unit(benchmark::kMicrosecond);
BENCHMARK(simulate_a_scan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodestar
