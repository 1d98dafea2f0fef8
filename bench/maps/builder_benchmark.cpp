#include <benchmark/benchmark.h>

#include "maps/map_file.hpp"
#include "maps/occupancy_builder.hpp"

#include "tests/maps/cast_scan.hpp"

// One scan of 720 beams in the lab, added to a map that has grown already.
namespace {

using namespace lodestar;

void add_scan(benchmark::State& state) {
  const OccupancyMap lab = load_map(std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml").map;
  const Pose2 pose{{1.2, 5.6}, 0.3};
  Random random(1);
  const Scan scan = testing::cast_scan(lab, {}, Stamp{}, [&](Stamp) { return pose; }, random, {.beams = 720});
  const std::vector<Pose2> poses = testing::poses_of(scan, pose);
  OccupancyBuilder builder;
  for (auto _ : state) benchmark::DoNotOptimize(builder.add(scan, poses));
}
BENCHMARK(add_scan)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
