#include <gtest/gtest.h>

#include "app/navigation/mission.hpp"

#include "tests/app/navigation/lab.hpp"

// Goals on the way, in the lab: along x from a place in front of which the floor is clear for 2.4 m.
namespace lodestar {
namespace {

struct Moment {
  double time_s = 0.0;
  double along_m = 0.0;    ///< by the truth, from the start
  double speed_mps = 0.0;  ///< by the truth, over 0.1 s
};

struct Flow {
  std::vector<MissionEvent> events;  ///< without path_planned
  std::vector<Moment> moments;
  std::string failure;

  /// The least speed between two places.
  [[nodiscard]] double slowest_mps(double from_m, double to_m) const {
    double slowest_mps = 10.0;
    for (const Moment& at : moments)
      if (at.along_m > from_m && at.along_m < to_m) slowest_mps = std::min(slowest_mps, at.speed_mps);
    return slowest_mps;
  }
  [[nodiscard]] double fastest_mps(double from_m, double to_m) const {
    double fastest_mps = 0.0;
    for (const Moment& at : moments)
      if (at.along_m > from_m && at.along_m < to_m) fastest_mps = std::max(fastest_mps, at.speed_mps);
    return fastest_mps;
  }
};

const Pose2 start{{1.2, 4.05}, 0.0};

Goal ahead(double x_m, bool passes) {
  return {.position_m = start * Vec2(x_m, 0.0), .passes = passes};
}

/// `happens` is asked before every step, with the way driven.
Flow drive(std::vector<Goal> goals, const std::function<void(Mission&, double)>& happens = {}) {
  Lab lab;
  lab.site.start = start;
  Simulation simulation = lab.simulation();
  BaseDriver base(simulation.can());
  Mission mission(lab.known, navigation_options(lab.site.robot), std::move(goals));
  Flow flow;
  double along_m = 0.0;
  std::vector<double> before_m(6, 0.0);
  for (int i = 0; i < 6000 && !mission.finished(); ++i) {
    if (happens) happens(mission, along_m);
    const MissionStep step = mission.step(sense(lab, simulation, base));
    base.command(step.navigation.command);
    const MissionEvent event = step.event;
    if (event != MissionEvent::none && event != MissionEvent::path_planned) flow.events.push_back(event);
    if (simulation.scorer().track().empty()) continue;
    const Pose2& truth = simulation.scorer().track().back().map_from_base;
    along_m = (inverse(start) * truth.position_m).x();
    before_m.erase(before_m.begin());
    before_m.push_back(along_m);
    flow.moments.push_back({seconds(period) * i, along_m, (before_m.back() - before_m.front()) / 0.1});
  }
  flow.failure = mission.failure();
  return flow;
}

const std::vector passed_then_arrived{MissionEvent::goal_passed, MissionEvent::goal_arrived};

TEST(Flow, a_point_on_a_straight_way_is_passed_without_a_stop) {
  const Flow flow = drive({ahead(1.0, true), ahead(2.0, false)});
  EXPECT_EQ(flow.events, passed_then_arrived) << flow.failure;
  EXPECT_GT(flow.slowest_mps(0.5, 1.5), 0.3);
}

TEST(Flow, a_goal_that_is_not_only_passed_makes_the_robot_rest) {
  const Flow flow = drive({ahead(1.0, false), ahead(2.0, false)});
  EXPECT_EQ(flow.events, std::vector(2, MissionEvent::goal_arrived)) << flow.failure;
  EXPECT_LT(flow.slowest_mps(0.9, 1.1), 0.01);
}

TEST(Flow, goals_appended_while_driving_make_no_stop) {
  bool is_appended = false;
  const Flow flow = drive({ahead(1.0, true)}, [&](Mission& mission, double along_m) {
    if (is_appended || along_m < 0.3) return;
    is_appended = true;
    mission.append({ahead(1.5, true), ahead(2.0, false)});
  });
  EXPECT_EQ(flow.events,
            (std::vector{MissionEvent::goal_passed, MissionEvent::goal_passed, MissionEvent::goal_arrived}))
      << flow.failure;
  EXPECT_GT(flow.slowest_mps(0.5, 1.5), 0.3);
}

TEST(Flow, goals_appended_too_late_to_go_on_are_reached_all_the_same) {
  bool is_appended = false;
  const Flow flow = drive({ahead(1.0, true)}, [&](Mission& mission, double along_m) {
    if (is_appended || along_m < 0.98) return;
    is_appended = true;
    mission.append({ahead(2.0, false)});
  });
  EXPECT_EQ(flow.events, passed_then_arrived) << flow.failure;
}

TEST(Flow, goals_appended_to_a_goal_of_rest_come_after_it) {
  bool is_appended = false;
  const Flow flow = drive({ahead(1.0, false)}, [&](Mission& mission, double along_m) {
    if (is_appended || along_m < 0.3) return;
    is_appended = true;
    mission.append({ahead(2.0, false)});
  });
  EXPECT_EQ(flow.events, std::vector(2, MissionEvent::goal_arrived)) << flow.failure;
  EXPECT_LT(flow.slowest_mps(0.9, 1.1), 0.01);
}

TEST(Flow, a_last_goal_becomes_one_that_is_passed) {
  bool is_appended = false;
  const Flow flow = drive({ahead(1.0, false)}, [&](Mission& mission, double along_m) {
    if (is_appended || along_m < 0.3) return;
    is_appended = true;
    mission.pass_last();
    mission.append({ahead(2.0, false)});
  });
  EXPECT_EQ(flow.events, passed_then_arrived) << flow.failure;
  EXPECT_GT(flow.slowest_mps(0.5, 1.5), 0.3);
}

TEST(Flow, a_trip_fails_as_a_whole) {
  const Goal behind_wall{.position_m = {-50.0, 0.0}, .heading_rad = {}, .passes = true};
  const Flow flow = drive({ahead(1.0, true), behind_wall, ahead(2.0, false)});
  EXPECT_EQ(flow.events, std::vector(3, MissionEvent::goal_failed));
  EXPECT_LT(flow.moments.back().along_m, 0.01);
}

/// Measured over 0.1 s, in which a step of the wheels' slip shows.
TEST(Flow, the_limit_of_a_leg_holds_from_its_beginning_to_its_end) {
  Goal slow = ahead(1.6, true);
  slow.max_mps = 0.2;
  const Flow flow = drive({ahead(1.0, true), slow, ahead(2.4, false)});
  EXPECT_EQ(flow.events,
            (std::vector{MissionEvent::goal_passed, MissionEvent::goal_passed, MissionEvent::goal_arrived}))
      << flow.failure;
  EXPECT_LE(flow.fastest_mps(1.0, 1.6), 0.21);
  EXPECT_GT(flow.slowest_mps(1.1, 1.5), 0.15);
  EXPECT_GT(flow.fastest_mps(0.3, 1.0), 0.35);
  EXPECT_GT(flow.fastest_mps(1.7, 2.4), 0.35);
}

TEST(Flow, a_goal_appended_behind_a_wall_fails_alone) {
  bool is_appended = false;
  const Flow flow = drive({ahead(1.0, true)}, [&](Mission& mission, double along_m) {
    if (is_appended || along_m < 0.3) return;
    is_appended = true;
    mission.append({{.position_m = {-50.0, 0.0}}});
  });
  EXPECT_EQ(flow.events, (std::vector{MissionEvent::goal_passed, MissionEvent::goal_failed}));
}

TEST(Flow, a_line_through_a_wall_is_a_failure_with_a_reason) {
  Goal goal = lab().goals.front();
  goal.on_line = true;
  const Flow flow = drive({goal});
  EXPECT_EQ(flow.events, std::vector{MissionEvent::goal_failed});
  EXPECT_EQ(flow.failure, "the straight line to the goal is blocked");
}

TEST(Flow, a_goal_on_a_line_fails_with_the_one_that_the_line_begins_at) {
  const Goal behind_wall{.position_m = {-50.0, 0.0}};
  Goal on_line = ahead(1.0, false);
  on_line.on_line = true;
  const Flow flow = drive({behind_wall, on_line, ahead(0.5, false)});
  EXPECT_EQ(flow.events,
            (std::vector{MissionEvent::goal_failed, MissionEvent::goal_failed, MissionEvent::goal_arrived}));
}

}  // namespace
}  // namespace lodestar
