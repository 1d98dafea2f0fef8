#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/navigation/mission.hpp"

#include "tests/app/navigation/lab.hpp"

// What is done at a mission's stops before they count as reached.
namespace lodestar {
namespace {

using ::testing::ElementsAre;

const Pose2 start{{1.2, 4.05}, 0.0};

Goal at(double x_m, double wait_s, const std::string& action = "") {
  return {.position_m = start * Vec2(x_m, 0.0), .wait = from_seconds(wait_s), .action = action};
}

struct Drive {
  std::vector<MissionEvent> events;  ///< without path_planned
  double reached_s = 0.0;            ///< when the robot came to rest at the first stop
  double driven_on_s = 0.0;          ///< when that counted as reached, or had failed
  std::vector<std::string> actions;  ///< handed out
  std::string failure;
};

/// `happens` is asked after every step, with the mission and how long the robot has been at its first stop.
Drive drive(std::vector<Goal> goals, const std::function<void(Mission&, double)>& happens = {}) {
  Lab lab;
  lab.site.start = start;
  Simulation simulation = lab.simulation();
  BaseDriver base(simulation.can());
  Mission mission(lab.known, navigation_options(lab.site.robot), std::move(goals));
  Drive drive;
  for (int i = 0; i < 6000 && !mission.finished(); ++i) {
    const MissionStep step = mission.step(sense(lab, simulation, base));
    base.command(step.navigation.command);
    const double now_s = seconds(simulation.now());
    if (mission.phase() == MissionPhase::at_stop && drive.reached_s == 0.0) drive.reached_s = now_s;
    if (step.event != MissionEvent::none && step.event != MissionEvent::path_planned) {
      drive.events.push_back(step.event);
      if (drive.events.size() == 1) drive.driven_on_s = now_s;
    }
    if (drive.reached_s > 0.0 && happens) happens(mission, now_s - drive.reached_s);
    if (std::string action = mission.take_action(); !action.empty()) drive.actions.push_back(action);
  }
  drive.failure = mission.failure();
  return drive;
}

TEST(MissionStops, are_stood_at_for_as_long_as_they_say) {
  const Drive waited = drive({at(0.5, 7.0), at(1.0, 0.0)});
  EXPECT_THAT(waited.events, ElementsAre(MissionEvent::goal_arrived, MissionEvent::goal_arrived));
  EXPECT_NEAR(waited.driven_on_s - waited.reached_s, 7.0, 0.05);
  EXPECT_EQ(drive({at(0.5, 0.0)}).reached_s, 0.0) << "never at a stop where nothing is to be done";
}

TEST(MissionStops, are_left_when_their_action_has_ended) {
  const Drive acted = drive({at(0.5, 1.0, "pick"), at(1.0, 0.0)}, [](Mission& mission, double at_stop_s) {
    if (at_stop_s > 4.0) mission.action_ended("");
  });
  EXPECT_THAT(acted.events, ElementsAre(MissionEvent::goal_arrived, MissionEvent::goal_arrived));
  EXPECT_NEAR(acted.driven_on_s - acted.reached_s, 4.0, 0.05);
  EXPECT_THAT(acted.actions, ElementsAre("pick")) << "handed out once";
}

TEST(MissionStops, are_where_the_drive_ends_when_their_action_fails) {
  const Drive failed = drive({at(0.5, 0.0, "pick"), at(1.0, 0.0)},
                             [](Mission& mission, double) { mission.action_ended("no box is there"); });
  EXPECT_THAT(failed.events, ElementsAre(MissionEvent::goal_failed)) << "what comes after may rely on it";
  EXPECT_EQ(failed.failure, "pick: no box is there");
}

TEST(MissionStops, whose_action_nobody_carries_out_fail_with_the_reason) {
  Lab lab;
  lab.site.start = start;
  Simulation simulation = lab.simulation();
  BaseDriver base(simulation.can());
  Mission mission(lab.known, navigation_options(lab.site.robot), {at(0.5, 0.0, "pick")});
  for (int i = 0; i < 3000 && !mission.finished(); ++i)
    base.command(mission.step(sense(lab, simulation, base)).navigation.command);
  EXPECT_TRUE(mission.finished());
  EXPECT_EQ(mission.failure(), "pick: nobody here carries it out");
}

TEST(MissionStops, have_their_action_begun_in_a_pause_too) {
  const Drive paused = drive({at(0.5, 0.0, "pick")}, [](Mission& mission, double at_stop_s) {
    if (at_stop_s < 0.5) mission.pause();
    if (at_stop_s > 7.0) mission.action_ended("");
    if (at_stop_s > 8.0) mission.resume();
  });
  EXPECT_THAT(paused.actions, ElementsAre("pick"));
  EXPECT_THAT(paused.events, ElementsAre(MissionEvent::goal_arrived)) << paused.failure;
}

TEST(MissionStops, are_held_by_a_pause_and_left_by_a_stop) {
  const Drive paused = drive({at(0.5, 1.0)}, [](Mission& mission, double at_stop_s) {
    if (at_stop_s < 0.5) mission.pause();
    if (at_stop_s > 3.0) mission.resume();
  });
  EXPECT_NEAR(paused.driven_on_s - paused.reached_s, 3.0, 0.1);
  const Drive stopped = drive({at(0.5, 100.0), at(1.0, 0.0)}, [](Mission& mission, double at_stop_s) {
    if (at_stop_s > 1.0 && at_stop_s < 1.05) mission.stop();
  });
  EXPECT_EQ(stopped.failure, "stopped by the operator");
  EXPECT_LT(stopped.driven_on_s - stopped.reached_s, 3.0);
}

}  // namespace
}  // namespace lodestar
