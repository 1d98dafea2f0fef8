#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

#include "control/hidden_corners.hpp"
#include "control/protective_field.hpp"
#include "maps/obstacle_memory.hpp"
#include "maps/random.hpp"

// 720 beams in a room of 8 m x 4 m with 1.5 cm of range noise.
namespace lodestar {
namespace {

DeskewedScan room(double at_s, Random& random) {
  DeskewedScan scan{.newest = Stamp(from_seconds(at_s)), .rays = {}};
  for (int i = 0; i < 720; ++i) {
    const Vec2 way(std::cos(0.5 * radians(i)), std::sin(0.5 * radians(i)));
    const double wall_m = std::min(4.0 / std::abs(way.x()), 2.0 / std::abs(way.y()));
    scan.rays.push_back({scan.newest, Vec2::Zero(), (wall_m + 0.015 * random.normal()) * way, Echo::hit});
  }
  return scan;
}

/// One control step; all hits are of the map, or all of people.
void field_of_720_beams(benchmark::State& state) {
  Random random(1);
  FieldScan scan{.newest = Stamp(from_seconds(1.0)), .points = {}};
  for (const Ray& ray : room(1.0, random).rays) {
    const Presence presence = state.range(0) == 0 ? Presence::mapped : Presence::person;
    scan.points.push_back({ray.stamp, ray.end_m, presence});
  }
  const ProtectiveField field{RobotShape(0.25)};
  const BodyVelocity full{0.6, 0.3};
  const Stamp now(from_seconds(1.1));
  for (auto _ : state) benchmark::DoNotOptimize(field.limit(scan, now, Pose2{}, full, full));
}
BENCHMARK(field_of_720_beams)
    ->Name("field/720_beams")
    ->ArgName("people")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

void memory_of_720_beams(benchmark::State& state) {
  Random random(1);
  ObstacleMemory memory;
  double at_s = 0.0;
  std::vector<DeskewedScan> scans;
  for (int i = 0; i < 32; ++i) scans.push_back(room(0.0, random));
  std::size_t next = 0;
  for (auto _ : state) {
    DeskewedScan& scan = scans[next++ % scans.size()];
    scan.newest = Stamp(from_seconds(at_s += 0.1));
    for (Ray& ray : scan.rays) ray.stamp = scan.newest;
    memory.add(scan);
  }
}
BENCHMARK(memory_of_720_beams)->Name("memory/720_beams")->Unit(benchmark::kMicrosecond);

void corners_of_720_beams(benchmark::State& state) {
  Random random(1);
  const DeskewedScan scan = room(0.0, random);
  for (auto _ : state) benchmark::DoNotOptimize(hidden_corners(scan, {}, [](const Vec2&) { return true; }));
}
BENCHMARK(corners_of_720_beams)->Name("corners/720_beams")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
