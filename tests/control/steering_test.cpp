#include "control/steering.hpp"

#include <gtest/gtest.h>

#include "tests/control/behaviours.hpp"

namespace lodestar {
namespace {

constexpr BodyVelocity full_ahead{2.0, 0.0};

Facts steered(const std::optional<BodyVelocity>& wanted, const std::optional<StopReason>& stop = {}) {
  Facts facts = calm();
  facts.steering = wanted;
  facts.stop = facts.stop_on_backtrack = stop;
  return facts;
}

struct Steering {
  Behaviour behaviour{Standing{}, Backtrack()};
  BodyVelocity command;

  void step(const Facts& facts) {
    const Moved after = moved(decided(std::move(behaviour), facts, {}), facts, {});
    behaviour = after.behaviour;
    command = after.command;
  }
};

TEST(Steering, is_slow_ahead_slower_backwards_and_within_what_the_map_leaves) {
  const SteeringOptions options;
  EXPECT_EQ(within(full_ahead, {}, options).forward_mps, options.max_forward_mps);
  EXPECT_EQ(within({-2.0, 0.0}, {}, options).forward_mps, -options.max_backward_mps);
  EXPECT_EQ(within({0.0, -9.0}, {}, options).turn_radps, -options.max_turn_radps);
  EXPECT_EQ(within(full_ahead, {.forward_mps = 0.1}, options).forward_mps, 0.1);
  EXPECT_EQ(within({-2.0, 0.0}, {.forward_mps = 0.0}, options).forward_mps, -options.max_backward_mps)
      << "away from what is ahead";
  EXPECT_EQ(within({-2.0, 0.0}, {.backward_mps = 0.05}, options).forward_mps, -0.05) << "in a speed zone";
}

TEST(Steering, needs_no_pose_but_a_base_that_answers) {
  EXPECT_TRUE(may_be_steered({}));
  EXPECT_TRUE(may_be_steered(StopReason::no_pose));
  EXPECT_TRUE(may_be_steered(StopReason::camera_dark));
  EXPECT_FALSE(may_be_steered(StopReason::base_silent));
  EXPECT_FALSE(may_be_steered(StopReason::wheels_broken));
}

TEST(Steering, changes_speed_within_the_acceleration_limit_and_ends_at_rest) {
  Steering robot;
  const DriveOptions limits;
  double last_mps = 0.0;
  const auto expect_gentle = [&] {
    EXPECT_LE(std::abs(robot.command.forward_mps - last_mps),
              limits.max_acceleration_mps2 * seconds(step_time) + 1e-9);
    last_mps = robot.command.forward_mps;
  };
  for (int i = 0; i < 100; ++i) {
    robot.step(steered(full_ahead, StopReason::no_pose));
    expect_gentle();
  }
  EXPECT_EQ(robot.command.forward_mps, SteeringOptions{}.max_forward_mps);
  for (int i = 0; i < 100; ++i) {
    robot.step(steered({}, StopReason::no_pose));  // the order was not renewed
    expect_gentle();
  }
  EXPECT_EQ(robot.command.forward_mps, 0.0);
  EXPECT_TRUE(std::holds_alternative<Standing>(robot.behaviour.state));
}

TEST(Steering, ends_when_the_base_falls_silent) {
  Steering robot;
  for (int i = 0; i < 100; ++i) robot.step(steered(full_ahead));
  for (int i = 0; i < 100; ++i) robot.step(steered(full_ahead, StopReason::base_silent));
  EXPECT_EQ(robot.command.forward_mps, 0.0);
}

TEST(Steering, does_not_take_over_a_trip) {
  Steering robot;
  robot.behaviour = {Following{{rolling_drive(), std::nullopt, false}}, places_behind()};
  robot.step(steered(BodyVelocity{0.0, 0.3}));
  EXPECT_TRUE(std::holds_alternative<Following>(robot.behaviour.state));
}

}  // namespace
}  // namespace lodestar
