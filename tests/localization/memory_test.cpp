#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "localization/pose/marker_tracker.hpp"
#include "localization/pose/pose_fixer.hpp"

#include "tests/localization/painted_frame.hpp"

// Counts allocations by replacing operator new, so this is a program of its own.
namespace {
std::atomic<int> times_taken = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++times_taken;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

namespace lodestar {
namespace {

RegisteredMarker registered(const CameraModel& camera, int id, const MarkerView& view) {
  return {.id = id, .position_m = camera_from_marker(camera, view).translation(), .yaw_rad = view.turn_rad};
}

/// Three markers, one of them without its O, and features that must not be taken for dots: a tube, glints on
/// markers, dots that touch.
struct Scene {
  CameraModel camera = paper_camera();
  MarkerRegistry registry;
  std::vector<cv::Mat> frames;

  Scene() {
    const MarkerView first{.middle_px = {150.0, 120.0}, .turn_rad = 0.4};
    const MarkerView second{.middle_px = {480.0, 170.0}, .turn_rad = 2.0};
    const MarkerView third{.middle_px = {330.0, 390.0}, .turn_rad = -1.1};
    registry.markers = {registered(camera, 1782, first), registered(camera, 447, second),
                        registered(camera, 3003, third)};
    Random random(3);
    for (int i = 0; i < 8; ++i) {
      PaintedFrame frame(cv::Size(camera.width_px, camera.height_px));
      frame.marker(camera, first, 1782);
      frame.marker(camera, second, 447);
      for (const GridCell cell : dots_of(3003))
        if (cell != cell_of_o) frame.dot(camera, third, cell, 246.0);
      frame.tube({20.0, 300.0}, {140.0, 330.0}, 9.0);
      for (int glint = 0; glint < 2 * i; ++glint)
        frame.disc({random.uniform(100.0, 560.0), random.uniform(80.0, 420.0)}, random.uniform(1.0, 5.0));
      frames.push_back(frame.finished(random));
    }
  }
};

TEST(Memory, is_taken_for_the_first_frames_only) {
  const Scene scene;
  MarkerTracker tracker(scene.registry, scene.camera);
  PoseFixer fixer(scene.registry, scene.camera);
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = 0.002;
  ExpectedView expected;
  expected.covariance.diagonal().setConstant(1e-5);
  int fixes = 0;
  const auto see_all = [&] {
    for (const cv::Mat& frame : scene.frames) {
      for (const auto& view : {std::optional<ExpectedView>(), std::optional(expected)})
        if (fixer.fix(Stamp{}, tracker.detect(frame, view), options) != nullptr) ++fixes;
    }
  };
  see_all();
  ASSERT_GT(times_taken, 0) << "allocations are counted";
  ASSERT_GE(fixes, 12) << "enough fixes to test anything";
  const int before = times_taken;
  see_all();
  EXPECT_EQ(times_taken, before);
}

}  // namespace
}  // namespace lodestar
