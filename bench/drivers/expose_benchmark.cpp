#include <benchmark/benchmark.h>

#include "drivers/simulation/image_former.hpp"
#include "maps/marker.hpp"
#include "maps/paper_camera.hpp"
#include "maps/random.hpp"

// Time to render one 640 x 480 frame of a lit ceiling with markers every 1.5 m, seen by a moving robot.
namespace lodestar {
namespace {

CameraModel wide_camera() {
  return {640, 480, 320.0, 320.0, 319.5, 239.5, Distortion::none, {}};
}

CameraModel distorted_camera() {
  CameraModel camera = wide_camera();
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.12, 0.02, 0.0008, -0.0005, 0.0};
  return camera;
}

MarkerRegistry lab_ceiling(double height_m) {
  Random random(1);
  MarkerRegistry registry;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 5; ++j) {
      const auto id = static_cast<int>(random.below(marker_id_count));
      registry.markers.push_back(
          {id, {0.75 + 1.5 * i, 0.75 + 1.5 * j, height_m}, random.uniform(-3.0, 3.0), 0});
    }
  }
  return registry;
}

void form_frames(benchmark::State& state, const CameraModel& camera, double height_m) {
  ImageFormer former(lab_ceiling(height_m), camera, {}, 1);
  std::uint64_t number = 0;
  for (auto _ : state) {
    // 0.5 m/s and 0.25 rad/s, open for 4 ms, a frame every 50 ms.
    const double time_s = 0.05 * static_cast<double>(number % 560);
    const Pose2 opening{{0.5 + 0.5 * time_s, 3.5}, 0.25 * time_s};
    const Pose2 closing{{opening.position_m.x() + 0.002, 3.5}, opening.yaw_rad + 0.001};
    benchmark::DoNotOptimize(former.expose(lifted(opening), lifted(closing), number));
    ++number;
  }
}

BENCHMARK_CAPTURE(form_frames, paper, paper_camera(), 2.6)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(form_frames, wide, wide_camera(), 1.5)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(form_frames, wide_distorted, distorted_camera(), 1.5)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
