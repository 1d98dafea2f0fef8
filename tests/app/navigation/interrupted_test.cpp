#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "tests/app/navigation/lab.hpp"

namespace lodestar {
namespace {

enum class Moment { backtracking, looking_around };

std::string name_of(const testing::TestParamInfo<Moment>& info) {
  return info.param == Moment::backtracking ? "Backtracking" : "LookingAround";
}

/// A drive through the lab under a plain ceiling. The lens is covered on the way, so the robot backtracks and
/// at last spins; then an event interrupts it.
class Interrupted : public testing::TestWithParam<Moment> {
 protected:
  void SetUp() override {
    lab.sees = [this](Stamp) { return !is_covered; };
    run(2.0);
    navigation.go_to(lab.site.goals.front());
    run(8.0);
    is_covered = true;
    ASSERT_TRUE(run(60.0, [&] { return is_the_moment(); }));
    changes.clear();
  }

  [[nodiscard]] bool is_the_moment() const {
    if (GetParam() == Moment::backtracking) return step.backtracks && step.command.forward_mps > 0.2;
    return step.stop && step.command.turn_radps == SpinOptions{}.turn_radps;
  }

  /// Runs until the condition holds (true) or the time has passed (false).
  bool run(double duration_s, const std::function<bool()>& until = [] { return false; }) {
    const Stamp end = simulation.now() + from_seconds(duration_s);
    while (simulation.now() < end) {
      SensorInput input = sense(lab, simulation, base);
      if (is_camera_lost) input.frames.clear();
      const BodyVelocity before = step.command;
      step = navigation.step(input);
      base.command(step.command);
      most_change_mps = std::max(most_change_mps, std::abs(step.command.forward_mps - before.forward_mps));
      most_change_radps = std::max(most_change_radps, std::abs(step.command.turn_radps - before.turn_radps));
      if (step.reroute) changes.push_back(step.reroute->change);
      if (until()) return true;
    }
    return false;
  }

  bool arrives() {
    return run(120.0, [&] { return navigation.arrived(); });
  }

  [[nodiscard]] bool stands() const {
    return step.command.forward_mps == 0.0 && step.command.turn_radps == 0.0;
  }

  void expect_gentle() {
    const DriveOptions limits = navigation_options(lab.site.robot).drive;
    EXPECT_LE(most_change_mps, limits.max_acceleration_mps2 * seconds(period) + 1e-9);
    EXPECT_LE(most_change_radps, limits.max_turn_acceleration_radps2 * seconds(period) + 1e-9);
    EXPECT_EQ(simulation.scorer().contacts(), 0);
  }

  [[nodiscard]] double distance_m(const Vec2& place_m) {
    return (simulation.scorer().track().back().map_from_base.position_m - place_m).norm();
  }

  static Lab under_plain_ceiling() {
    Lab lab;
    lab.disturbances.plain_ceiling = true;
    return lab;
  }

  Lab lab = under_plain_ceiling();
  Simulation simulation = lab.simulation();
  BaseDriver base{simulation.can()};
  Navigation navigation{lab.known, navigation_options(lab.site.robot)};
  NavigationStep step;
  std::vector<RouteChange> changes;
  bool is_covered = false;
  bool is_camera_lost = false;
  double most_change_mps = 0.0;
  double most_change_radps = 0.0;
};

INSTANTIATE_TEST_SUITE_P(While, Interrupted, testing::Values(Moment::backtracking, Moment::looking_around),
                         name_of);

TEST_P(Interrupted, by_nothing_it_drives_on_when_it_sees_again) {
  is_covered = false;
  EXPECT_TRUE(arrives());
  EXPECT_LT(distance_m(lab.site.goals.front().position_m), 0.02);
  expect_gentle();
}

TEST_P(Interrupted, by_a_pause_it_stands_and_then_goes_on_with_what_it_was_about) {
  navigation.pause();
  EXPECT_TRUE(navigation.paused());
  run(3.0);
  const Vec2 place_m = simulation.scorer().track().back().map_from_base.position_m;
  run(3.0);
  EXPECT_TRUE(stands());
  EXPECT_LT(distance_m(place_m), 1e-3);
  navigation.resume();
  EXPECT_FALSE(navigation.paused());
  EXPECT_TRUE(run(10.0, [&] { return is_the_moment(); }));
  is_covered = false;
  EXPECT_TRUE(arrives());
  expect_gentle();
}

TEST_P(Interrupted, by_a_cancel_it_never_drives_on) {
  navigation.cancel();
  run(3.0);
  EXPECT_TRUE(stands());
  const Vec2 place_m = simulation.scorer().track().back().map_from_base.position_m;
  is_covered = false;
  run(20.0);
  EXPECT_TRUE(stands());
  EXPECT_LT(distance_m(place_m), 1e-3);
  EXPECT_FALSE(navigation.arrived());
  EXPECT_TRUE(changes.empty());
  expect_gentle();
}

TEST_P(Interrupted, by_a_halt_it_commands_zero_at_once_and_never_drives_on) {
  navigation.halt();
  run(0.02);
  EXPECT_TRUE(stands());
  is_covered = false;
  EXPECT_FALSE(run(20.0, [&] { return !stands(); }));
}

TEST_P(Interrupted, by_another_goal_it_comes_to_rest_and_drives_there_when_it_sees_again) {
  const Vec2 elsewhere_m = lab.site.start.position_m;
  navigation.go_to({elsewhere_m, std::nullopt});
  run(3.0);
  is_covered = false;
  EXPECT_TRUE(arrives());
  EXPECT_LT(distance_m(elsewhere_m), 0.02);
  EXPECT_EQ(std::ranges::count(changes, RouteChange::new_goal), 1);
  expect_gentle();
}

TEST_P(Interrupted, by_a_changed_map_it_plans_on_that_one_when_it_sees_again) {
  OccupancyMap map = lab.known.map;
  for (double y_m = 2.9; y_m <= 3.8; y_m += 0.5 * map.resolution_m)
    map.cells[map.index(map.cell_at({8.9, y_m}))] = OccupancyMap::occupied;  // the corridor is closed
  simulation.change_map(map);
  navigation.map_changed(map);
  run(3.0);
  is_covered = false;
  EXPECT_TRUE(arrives());
  EXPECT_TRUE(std::ranges::any_of(simulation.scorer().track(), [](const auto& at) {
    return at.map_from_base.position_m.x() > 7.0 && at.map_from_base.position_m.y() > 4.8;
  })) << "through the upper rooms";
  expect_gentle();
}

TEST_P(Interrupted, by_a_lost_camera_it_stands_and_says_so_and_drives_on_when_it_is_back) {
  is_camera_lost = true;
  run(4.0);
  EXPECT_TRUE(stands());
  EXPECT_EQ(step.stop, StopReason::camera_silent);
  run(4.0);
  EXPECT_TRUE(stands());
  is_camera_lost = is_covered = false;
  EXPECT_TRUE(arrives());
  expect_gentle();
}

}  // namespace
}  // namespace lodestar
