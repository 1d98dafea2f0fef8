#include "drivers/simulation/simulation.hpp"

#include <gtest/gtest.h>
#include <sstream>

#include "drivers/base/base_driver.hpp"
#include "drivers/can/candump.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

OccupancyMap free_floor() {
  return empty_floor(100, 60, 0.1);
}

CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx_px = camera.fy_px = 32.0;
  camera.cx_px = 31.5;
  camera.cy_px = 23.5;
  return camera;
}

SimulationOptions started_at(const Vec2& position_m, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.start.position_m = position_m;
  options.base_from_camera.translation().z() = 0.5;
  options.seed = seed;
  return options;
}

MarkerRegistry one_marker() {
  return {{}, {{447, {2.0, 3.0, 2.0}, 0.0, 0}}};
}

/// Drives straight for `time` with the navigator's own driver, and returns the bus log.
std::string drive_straight(Simulation& simulation, Duration time) {
  std::ostringstream log;
  CandumpWriter writer(log);
  simulation.on_can_frame([&](const StampedCanFrame& frame) { writer.write(frame); });
  BaseDriver driver(simulation.can());
  const Stamp end = simulation.now() + time;
  while (simulation.now() < end) {
    simulation.advance(milliseconds(20));
    driver.poll(simulation.now());
    driver.command({0.5, 0.0});
  }
  simulation.on_can_frame({});
  return log.str();
}

TEST(Simulation, starts_at_time_zero_and_moves_in_whole_steps) {
  Simulation simulation(free_floor(), one_marker(), small_camera(), started_at({2.0, 3.0}));
  EXPECT_EQ(simulation.now(), Stamp{});
  simulation.advance(std::chrono::microseconds(700));
  EXPECT_EQ(simulation.now(), Stamp{});
  simulation.advance(std::chrono::microseconds(700));
  EXPECT_EQ(simulation.now(), Stamp(milliseconds(1)));
  simulation.advance(std::chrono::microseconds(600));
  EXPECT_EQ(simulation.now(), Stamp(milliseconds(2)));
}

TEST(Simulation, drives_by_frames_and_shows_the_judge_the_truth) {
  Simulation simulation(free_floor(), one_marker(), small_camera(), started_at({2.0, 3.0}));
  simulation.scorer().claim_path({{{2.0, 3.0}, {9.0, 3.0}}});
  drive_straight(simulation, std::chrono::seconds(4));
  const Scorer& scorer = simulation.scorer();
  ASSERT_EQ(scorer.track().size(), 201U) << "50 per second, plus the start";
  EXPECT_EQ(scorer.track().front().map_from_base.position_m, Vec2(2.0, 3.0));
  EXPECT_NEAR(scorer.track().back().map_from_base.position_m.x(), 3.9, 0.1);
  EXPECT_EQ(scorer.track().back().stamp, simulation.now());
  EXPECT_EQ(scorer.contacts(), 0);
  EXPECT_GT(scorer.path_distances_m().size(), 180U);
  EXPECT_GT(scorer.path_distances_m().back(), 0.02) << "the wheels are unequal";
}

TEST(Simulation, tells_the_judge_of_a_robot_that_runs_against_a_wall) {
  Simulation simulation(free_floor(), one_marker(), small_camera(), started_at({9.5, 3.0}));
  drive_straight(simulation, std::chrono::seconds(3));
  EXPECT_EQ(simulation.scorer().contacts(), 1);
  EXPECT_LE(simulation.scorer().track().back().map_from_base.position_m.x(), 9.75 + 1e-9);
}

TEST(Simulation, lets_people_press_the_emergency_stop) {
  Simulation simulation(free_floor(), one_marker(), small_camera(), started_at({2.0, 3.0}));
  drive_straight(simulation, std::chrono::seconds(1));
  simulation.base().press_emergency_stop(true);
  drive_straight(simulation, std::chrono::seconds(1));
  const Vec2 at_rest = simulation.scorer().track().back().map_from_base.position_m;
  drive_straight(simulation, std::chrono::seconds(1));
  EXPECT_EQ(simulation.scorer().track().back().map_from_base.position_m, at_rest);
}

TEST(Simulation, refuses_a_step_in_which_no_time_passes) {
  SimulationOptions options;
  options.physics_step = Duration::zero();
  EXPECT_THROW(Simulation(free_floor(), one_marker(), small_camera(), options), InputError);
}

TEST(Simulation, gives_pictures_stamped_with_their_exposure) {
  Simulation simulation(free_floor(), one_marker(), small_camera(), started_at({2.0, 3.0}));
  int frames = 0;
  Stamp last;
  for (int i = 0; i < 100; ++i) {
    simulation.advance(milliseconds(20));
    while (const auto frame = simulation.camera().poll()) {
      ++frames;
      EXPECT_GT(frame->stamp, last);
      EXPECT_LT(frame->stamp, simulation.now());
      EXPECT_EQ(frame->gray.cols, 64);
      last = frame->stamp;
    }
  }
  EXPECT_NEAR(frames, 40, 5);
}

TEST(Simulation, repeats_itself_byte_for_byte) {
  const auto run = [](std::uint64_t seed, const SimulatedCameraOptions& camera) {
    SimulationOptions options = started_at({2.0, 3.0}, seed);
    options.camera = camera;
    Simulation simulation(free_floor(), one_marker(), small_camera(), options);
    const std::string log = drive_straight(simulation, std::chrono::seconds(3));
    return std::pair(log, simulation.scorer().track().back().map_from_base.position_m);
  };
  SimulatedCameraOptions slow_camera;
  slow_camera.period = milliseconds(100);
  EXPECT_EQ(run(5, {}), run(5, {}));
  EXPECT_EQ(run(5, {}), run(5, slow_camera)) << "the camera has its own random stream";
  EXPECT_NE(run(5, {}).second, run(6, {}).second);
}

}  // namespace
}  // namespace lodestar
