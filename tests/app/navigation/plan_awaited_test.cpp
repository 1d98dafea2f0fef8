#include <gtest/gtest.h>

#include "tests/app/navigation/lab.hpp"

namespace lodestar {
namespace {

const Vec2 near_m{2.2, 5.0};
const Vec2 far_m{13.0, 2.0};

/// A robot in the lab that knows where it is and stands.
class PlanAwaited : public ::testing::Test {
 protected:
  void SetUp() override { run(100); }

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      step = navigation.step(sense(world, simulation, base));
      base.command(step.command);
      moves = moves || step.command.forward_mps != 0.0 || step.command.turn_radps != 0.0;
      if (step.reroute) updates.push_back(*step.reroute);
    }
  }

  Lab world;
  Simulation simulation = world.simulation();
  BaseDriver base{simulation.can()};
  Navigation navigation{world.known, navigation_options(world.site.robot)};
  NavigationStep step;
  std::vector<RouteUpdate> updates;
  bool moves = false;
};

TEST_F(PlanAwaited, arrives_the_stated_number_of_steps_after_the_step_that_asked) {
  navigation.go_to({far_m, std::nullopt});
  run(5);
  EXPECT_TRUE(updates.empty());
  EXPECT_FALSE(moves);
  run(1);
  ASSERT_EQ(updates.size(), 1U);
  EXPECT_EQ(updates.front().change, RouteChange::new_goal);
  run(5);
  EXPECT_TRUE(moves);
}

TEST_F(PlanAwaited, is_dropped_when_the_trip_is_cancelled) {
  navigation.go_to({far_m, std::nullopt});
  run(3);
  navigation.cancel();
  run(50);
  EXPECT_TRUE(updates.empty());
  EXPECT_FALSE(moves);
}

TEST_F(PlanAwaited, is_dropped_when_the_robot_is_halted) {
  navigation.go_to({far_m, std::nullopt});
  run(3);
  navigation.halt();
  run(50);
  EXPECT_TRUE(updates.empty());
  EXPECT_FALSE(moves);
}

TEST_F(PlanAwaited, is_asked_for_again_after_a_pause) {
  navigation.go_to({far_m, std::nullopt});
  run(3);
  navigation.pause();
  run(50);
  EXPECT_TRUE(updates.empty());
  EXPECT_FALSE(moves);
  navigation.resume();
  run(6);
  EXPECT_EQ(updates.size(), 1U);
}

TEST_F(PlanAwaited, to_the_goal_before_is_never_driven) {
  navigation.go_to({near_m, std::nullopt});
  run(3);
  navigation.go_to({far_m, std::nullopt});
  run(5);
  EXPECT_TRUE(updates.empty());
  run(20);
  ASSERT_EQ(updates.size(), 1U);
  EXPECT_EQ(updates.front().route.path.waypoints_m.back(), far_m);
}

TEST_F(PlanAwaited, to_an_occupied_goal_says_so) {
  navigation.go_to({{0.0, 0.0}, std::nullopt});
  run(6);
  ASSERT_EQ(updates.size(), 1U);
  EXPECT_EQ(updates.front().failure, PlanFailure::goal_occupied);
  EXPECT_FALSE(moves);
}

/// Where the robot was in eight seconds with a plan in them.
std::vector<Vec2> drive_with(PlannerKind planner) {
  Lab world;
  Simulation simulation = world.simulation();
  BaseDriver base(simulation.can());
  NavigationOptions options = navigation_options(world.site.robot);
  options.planner.kind = planner;
  Navigation navigation(world.known, options);
  std::vector<Vec2> places_m;
  for (int i = 0; i < 400; ++i) {
    const NavigationStep step = navigation.step(sense(world, simulation, base));
    base.command(step.command);
    if (i == 100) navigation.go_to({far_m, std::nullopt});
    if (step.estimate) places_m.push_back(step.estimate->map_from_base.position_m);
  }
  return places_m;
}

TEST(Navigation, drives_the_same_again_however_long_its_planner_takes) {
  EXPECT_EQ(drive_with(PlannerKind::fastest), drive_with(PlannerKind::fastest));
  EXPECT_EQ(drive_with(PlannerKind::bitstar), drive_with(PlannerKind::bitstar));
}

}  // namespace
}  // namespace lodestar
