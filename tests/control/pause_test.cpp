#include <gtest/gtest.h>

#include "control/rotate_then_drive.hpp"

#include "tests/control/plant.hpp"

namespace lodestar {
namespace {

const Path path{{Vec2::Zero(), Vec2(3.0, 0.0), Vec2(3.0, 2.0)}};

BodyVelocity run(RotateThenDrive& controller, Plant& plant, int steps, const SpeedLimit& limit = {}) {
  BodyVelocity command;
  for (int step = 0; step < steps && !controller.arrived(); ++step)
    plant.run(command = controller.update(plant.sensed(), from_seconds(period_s), limit));
  return command;
}

BodyVelocity slow_down(RotateThenDrive& controller, Plant& plant, int steps) {
  BodyVelocity command;
  for (int step = 0; step < steps; ++step) plant.run(command = controller.slow_down(from_seconds(period_s)));
  return command;
}

TEST(Pause, comes_to_rest_gently_and_goes_on_to_the_same_goal) {
  RotateThenDrive controller(path, std::nullopt);
  Plant plant;
  const BodyVelocity before = run(controller, plant, 150);
  ASSERT_GT(before.forward_mps, 0.4);
  const BodyVelocity next = slow_down(controller, plant, 1);
  EXPECT_GE(next.forward_mps, before.forward_mps - 0.5 * period_s - 1e-9) << "within the deceleration limit";
  slow_down(controller, plant, 100);
  const Pose2 paused = plant.truth;
  slow_down(controller, plant, 100);
  EXPECT_LT((plant.truth.position_m - paused.position_m).norm(), 1e-3);
  run(controller, plant, 3000);
  EXPECT_TRUE(controller.arrived());
  EXPECT_LT((plant.truth.position_m - Vec2(3.0, 2.0)).norm(), 0.015);
}

TEST(Pause, of_the_last_turn_goes_on_too) {
  RotateThenDrive controller({{Vec2::Zero(), Vec2(0.5, 0.0)}}, radians(170.0));
  Plant plant;
  while (controller.phase() != DrivePhase::final_rotation) run(controller, plant, 1);
  run(controller, plant, 30);
  EXPECT_EQ(slow_down(controller, plant, 100).turn_radps, 0.0);
  run(controller, plant, 2000);
  EXPECT_TRUE(controller.arrived());
  EXPECT_NEAR(plant.truth.yaw_rad, radians(170.0), radians(1.5));
}

TEST(Pause, another_path_begins_at_the_speed_of_the_one_before) {
  RotateThenDrive controller(path, std::nullopt);
  Plant plant;
  const BodyVelocity before = run(controller, plant, 150);
  RotateThenDrive other({{plant.truth.position_m, Vec2(1.0, 2.0)}}, std::nullopt);
  other.take_over_from(controller);
  EXPECT_FALSE(other.at_rest());
  EXPECT_NEAR(run(other, plant, 1).forward_mps, before.forward_mps - 0.5 * period_s, 1e-9)
      << "at the deceleration limit";
  run(other, plant, 3000);
  EXPECT_TRUE(other.arrived());
  EXPECT_LT((plant.truth.position_m - Vec2(1.0, 2.0)).norm(), 0.015);
}

TEST(Pause, looking_around_turns_on_the_spot_and_the_drive_goes_on_from_there) {
  RotateThenDrive controller(path, std::nullopt);
  Plant plant;
  run(controller, plant, 150);
  BodyVelocity last;
  for (int step = 0; step < 400; ++step) {
    const BodyVelocity command = controller.turn_around(0.4, from_seconds(period_s));
    if (last.forward_mps > 0.0) {
      EXPECT_LE(std::abs(command.turn_radps), std::abs(last.turn_radps) + 1e-12)
          << "no faster turn while rolling";
    }
    plant.run(last = command);
  }
  EXPECT_NEAR(last.turn_radps, 0.4, 1e-12);
  run(controller, plant, 3000);
  EXPECT_TRUE(controller.arrived());
  EXPECT_LT((plant.truth.position_m - Vec2(3.0, 2.0)).norm(), 0.015);
}

TEST(SpeedLimit, is_kept_on_the_way_and_arrival_does_not_suffer) {
  RotateThenDrive controller(path, std::nullopt);
  Plant plant;
  for (int step = 0; step < 5000 && !controller.arrived(); ++step) {
    EXPECT_LE(run(controller, plant, 1, {.forward_mps = 0.15, .turn_radps = 0.3}).forward_mps, 0.15 + 1e-12);
  }
  EXPECT_TRUE(controller.arrived());
  EXPECT_LT((plant.truth.position_m - Vec2(3.0, 2.0)).norm(), 0.015);
}

TEST(SpeedLimit, of_nothing_holds_the_robot_until_it_is_lifted) {
  RotateThenDrive controller({{Vec2::Zero(), Vec2(2.0, 0.0)}}, std::nullopt);
  Plant plant;
  run(controller, plant, 100, {.forward_mps = 0.0});
  EXPECT_LT(plant.truth.position_m.norm(), 1e-3);
  run(controller, plant, 2000);
  EXPECT_TRUE(controller.arrived());
}

}  // namespace
}  // namespace lodestar
