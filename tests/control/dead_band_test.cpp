#include <gtest/gtest.h>

#include "control/rotate_then_drive.hpp"

#include "tests/control/plant.hpp"

namespace lodestar {
namespace {

// Wheels stand still below 1 cm/s, which is their speed in a turn of 0.05 rad/s.
constexpr double dead_band_mps = 0.01;

TEST(DeadBand, turns_and_legs_end_all_the_same) {
  Random random(11);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Vec2 goal(random.uniform(0.2, 2.0), random.uniform(-1.0, 1.0));
    const double heading = random.uniform(-3.1, 3.1);
    RotateThenDrive controller({{Vec2::Zero(), goal}}, heading);
    Plant plant;
    plant.random = Random(seed);
    plant.dead_band_mps = dead_band_mps;
    int steps = 0;
    while (!controller.arrived() && steps++ < 3000)
      plant.run(controller.update(plant.sensed(), from_seconds(period_s)));
    ASSERT_TRUE(controller.arrived()) << "seed " << seed;
    for (int i = 0; i < 50; ++i) plant.run({});
    EXPECT_LT((plant.truth.position_m - goal).norm(), 0.015) << "seed " << seed;
    EXPECT_LT(std::abs(wrap_angle(plant.truth.yaw_rad - heading)), radians(1.5)) << "seed " << seed;
  }
}

TEST(DeadBand, would_hold_a_robot_that_turns_too_slowly) {
  DriveOptions options;
  options.min_turn_radps = 0.0;
  options.max_turn_radps = 0.04;  // 8 mm/s at the wheels
  RotateThenDrive controller({{Vec2::Zero(), Vec2(0.0, 1.0)}}, std::nullopt, options);
  Plant plant;
  plant.dead_band_mps = dead_band_mps;
  for (int step = 0; step < 3000; ++step)
    plant.run(controller.update(plant.sensed(), from_seconds(period_s)));
  EXPECT_EQ(plant.truth.yaw_rad, 0.0);
}

TEST(DeadBand, a_speed_limit_never_turns_slower_than_the_motors_can) {
  const DriveOptions options;
  RotateThenDrive controller({{Vec2::Zero(), Vec2(0.0, 1.0)}}, std::nullopt, options);
  PoseEstimate estimate;
  BodyVelocity command;
  for (int step = 0; step < 50; ++step)
    command = controller.update(estimate, from_seconds(period_s), {.forward_mps = 0.1, .turn_radps = 0.001});
  EXPECT_EQ(command.turn_radps, options.min_turn_radps);
}

TEST(DeadBand, a_robot_beside_its_leg_is_never_driven_slower_than_the_motors_can) {
  const DriveOptions options;
  RotateThenDrive controller({{Vec2::Zero(), Vec2(1.0, 0.0)}}, std::nullopt, options);
  PoseEstimate estimate;
  BodyVelocity command;
  for (int step = 0; step < 20; ++step) controller.update(estimate, from_seconds(period_s));
  estimate.map_from_base = {Vec2(0.9974, 0.05), radians(10.0)};
  for (int step = 0; step < 100; ++step) command = controller.update(estimate, from_seconds(period_s));
  ASSERT_EQ(controller.phase(), DrivePhase::driving);
  EXPECT_EQ(command.forward_mps, options.min_forward_mps);
}

}  // namespace
}  // namespace lodestar
