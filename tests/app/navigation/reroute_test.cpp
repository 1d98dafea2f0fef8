#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

#include "app/navigation/mission.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "drivers/base/base_driver.hpp"
#include "drivers/simulation/simulation.hpp"

namespace lodestar {
namespace {

constexpr Duration period = std::chrono::milliseconds(20);

/// A drive through the lab to the first goal, with events on the way.
class Reroute : public testing::Test {
 protected:
  /// `happens` is asked before every step, with the time since the start.
  void drive(const std::function<void(double)>& happens) {
    while (!mission.finished()) {
      happens(seconds(simulation.now()));
      simulation.advance(period);
      SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
      while (std::optional<Frame> frame = simulation.camera().poll())
        input.frames.push_back(std::move(*frame));
      const MissionStep step = mission.step(input);
      base.command(step.navigation.command);
      if (step.event == MissionEvent::path_planned) paths.push_back(mission.path());
      const std::optional<RouteUpdate>& reroute = step.navigation.reroute;
      if (reroute && reroute->change != RouteChange::new_goal) changes.push_back(reroute->change);
      arrived = arrived || step.event == MissionEvent::goal_arrived;
    }
  }

  /// A row of boxes across the lab, in the simulated world and on the robot's map.
  void block(double x_m, double from_y_m, double to_y_m) {
    for (double y_m = from_y_m; y_m <= to_y_m; y_m += 0.5 * map.resolution_m) {
      map.cells[map.index(map.cell_at({x_m, y_m}))] = OccupancyMap::occupied;
    }
    simulation.change_map(map);
    mission.map_changed(map);
  }

  void close_corridor() { block(8.9, 2.9, 3.8); }
  void close_upper_rooms() { block(10.2, 5.1, 6.4); }

  [[nodiscard]] double goal_error_m() {
    return (simulation.scorer().track().back().map_from_base.position_m - goal.position_m).norm();
  }

  Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  Goal goal = site.goals.front();
  KnownWorld known = known_world(site, "wide");
  OccupancyMap map = known.map;
  Simulation simulation{known.map,
                        known.registry,
                        known.camera,
                        {.start = site.start,
                         .robot_radius_m = site.robot.radius_m,
                         .base_from_camera = site.robot.base_from_camera}};
  BaseDriver base{simulation.can()};
  Mission mission{known, navigation_options(site.robot), {goal}};
  std::vector<Path> paths;  ///< in the order planned
  std::vector<RouteChange> changes;
  bool arrived = false;
};

TEST_F(Reroute, plans_anew_when_pushed_off_its_path_and_arrives) {
  bool pushed = false;
  drive([&](double time_s) {
    if (!pushed && time_s > 9.0) {
      simulation.push({{0.0, -0.27}, 0.2});  // a larger push would count as kidnapping
      pushed = true;
    }
  });
  EXPECT_TRUE(arrived) << mission.failure();
  ASSERT_EQ(changes, std::vector{RouteChange::left_path});
  EXPECT_EQ(paths.size(), 2U);
  EXPECT_LT(goal_error_m(), 0.02);
  EXPECT_EQ(simulation.scorer().contacts(), 0);
}

TEST_F(Reroute, takes_another_way_when_the_corridor_is_closed_on_the_map) {
  bool closed = false;
  drive([&](double time_s) {
    if (!closed && time_s > 10.0) {
      close_corridor();
      closed = true;
    }
  });
  EXPECT_TRUE(arrived) << mission.failure();
  ASSERT_EQ(changes, std::vector{RouteChange::blocked});
  EXPECT_TRUE(std::ranges::any_of(paths.back().waypoints_m, [](const Vec2& at) { return at.y() > 4.8; }))
      << "through the upper rooms";
  EXPECT_LT(goal_error_m(), 0.02);
  EXPECT_EQ(simulation.scorer().contacts(), 0);
}

TEST_F(Reroute, keeps_its_way_when_the_map_changes_elsewhere) {
  bool changed = false;
  drive([&](double time_s) {
    if (!changed && time_s > 10.0) {
      block(2.0, 0.2, 1.5);
      changed = true;
    }
  });
  EXPECT_TRUE(arrived) << mission.failure();
  EXPECT_TRUE(changes.empty());
  EXPECT_EQ(paths.size(), 1U);
}

TEST_F(Reroute, stops_and_says_so_when_no_way_is_left) {
  bool closed = false;
  drive([&](double time_s) {
    if (!closed && time_s > 10.0) {
      close_corridor();
      close_upper_rooms();
      closed = true;
    }
  });
  EXPECT_FALSE(arrived);
  EXPECT_EQ(changes, std::vector{RouteChange::lost});
  EXPECT_EQ(mission.failure(), "no path any more: no path to the goal");
  EXPECT_EQ(simulation.scorer().contacts(), 0);
}

TEST_F(Reroute, looks_at_a_changed_map_only_after_a_pause) {
  Navigation navigation(known, navigation_options(site.robot));
  std::vector<RouteChange> seen;
  const auto run = [&](int steps) {
    BodyVelocity command;
    for (int i = 0; i < steps; ++i) {
      simulation.advance(period);
      SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
      while (std::optional<Frame> frame = simulation.camera().poll())
        input.frames.push_back(std::move(*frame));
      const NavigationStep step = navigation.step(input);
      command = step.command;
      base.command(command);
      if (step.reroute && step.reroute->change != RouteChange::new_goal) seen.push_back(step.reroute->change);
    }
    return command;
  };
  run(100);
  navigation.go_to(goal);
  run(300);
  navigation.pause();
  run(100);
  close_corridor();
  navigation.map_changed(map);
  EXPECT_EQ(run(100).forward_mps, 0.0);
  EXPECT_TRUE(seen.empty());
  navigation.resume();
  run(20);
  EXPECT_EQ(seen, std::vector{RouteChange::blocked});
  run(300);
  navigation.cancel();
  run(200);
  navigation.map_changed(known.map);
  EXPECT_EQ(run(50).forward_mps, 0.0) << "there is no path to follow";
}

}  // namespace
}  // namespace lodestar
