#include <gtest/gtest.h>

#include "app/navigation/mission.hpp"

#include "tests/app/navigation/lab.hpp"

// Someone walks before the robot, who never passes.
namespace lodestar {
namespace {

const Pose2 start{{1.2, 4.05}, 0.0};

MovingDisc on(std::vector<DiscKey> keys, bool loops) {
  MovingDisc disc;
  disc.trajectory = {.keys = std::move(keys), .loops = loops};
  return disc;
}

/// Along x, from 1.2 m before the robot to 2 m farther on in 25 s, then aside.
MovingDisc walks_ahead() {
  const Vec2 to_m = start * Vec2(3.2, 0.0);
  return on({{Duration{}, start * Vec2(1.2, 0.0)},
             {std::chrono::seconds(25), to_m},
             {std::chrono::seconds(28), to_m + Vec2(0.0, -2.0)}},
            false);
}

/// Up and down before the robot, never standing.
MovingDisc paces_up_and_down() {
  const Vec2 near_m = start * Vec2(1.2, 0.0);
  return on({{Duration{}, near_m},
             {std::chrono::seconds(2), start * Vec2(1.8, 0.0)},
             {std::chrono::seconds(4), near_m}},
            true);
}

/// So near that the robot stands, for longer than it would wait for a thing; then aside, and off any detour.
MovingDisc steps_from_foot_to_foot() {
  std::vector<DiscKey> keys;
  for (int s = 0; s < 75; s += 2) {
    keys.push_back({std::chrono::seconds(s), start * Vec2(0.9, 0.0)});
    keys.push_back({std::chrono::seconds(s + 1), start * Vec2(1.0, 0.0)});
  }
  keys.push_back({std::chrono::seconds(78), start * Vec2(1.0, -3.0)});
  return on(std::move(keys), false);
}

struct Outcome {
  bool arrived = false;
  std::string failure;
};

Outcome drive_among(const MovingDisc& person, Duration max_hindered = std::chrono::seconds(15)) {
  Lab lab;
  lab.site.start = start;
  lab.site.robot.scanner.emplace();
  SimulationOptions options;
  options.start = start;
  options.base_from_camera = lab.site.robot.base_from_camera;
  options.robot_radius_m = lab.site.robot.radius_m;
  options.base.track_width_m = lab.site.robot.track_width_m;
  options.base.max_wheel_acceleration_mps2 = 2.0;
  options.scanner = SimulatedScannerOptions{.mount = lab.site.robot.scanner->mount};
  options.discs = {person};
  Simulation simulation(lab.known.map, lab.installed, lab.known.camera, options);
  BaseDriver base(simulation.can());
  MissionOptions patience;
  patience.max_hindered = max_hindered;
  patience.progress_m = 0.5;
  const std::vector<Goal> goals{{.position_m = start * Vec2(2.8, 0.0)}};
  Mission mission(lab.known, navigation_options(lab.site.robot), goals, patience);
  Outcome outcome;
  for (int i = 0; i < 10000 && !mission.finished(); ++i) {
    SensorInput input = sense(lab, simulation, base);
    while (std::optional<Scan> scan = simulation.scanner()->poll()) input.scans.push_back(std::move(*scan));
    input.packets = simulation.scanner()->packets();
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);
    if (step.event == MissionEvent::goal_arrived) outcome.arrived = true;
  }
  outcome.failure = mission.failure();
  return outcome;
}

/// Hindered for longer in all than its patience, but half a metre nearer before that.
TEST(Hindered, who_comes_nearer_to_the_goal_goes_on) {
  const Outcome outcome = drive_among(walks_ahead());
  EXPECT_TRUE(outcome.arrived) << outcome.failure;
}

TEST(Hindered, who_does_not_gives_up) {
  const Outcome outcome = drive_among(paces_up_and_down());
  EXPECT_FALSE(outcome.arrived);
  EXPECT_EQ(outcome.failure, "people or things in the way for too long");
}

TEST(Hindered, who_stands_before_a_person_waits_as_long_as_who_creeps) {
  const Outcome outcome = drive_among(steps_from_foot_to_foot(), std::chrono::seconds(120));
  EXPECT_TRUE(outcome.arrived) << outcome.failure;
}

}  // namespace
}  // namespace lodestar
