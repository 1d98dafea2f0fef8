#include "app/navigation/charging.hpp"

#include <gmock/gmock.h>

#include "app/simulate/simulated_drive.hpp"

// Drives of the simulated robot onto its dock. The battery is the world's: the robot hears its voltage only.
namespace lodestar {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// The lab with a dock beside the start.
Site lab_with_dock() {
  Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  site.charging = ChargingSettings{
      .place = "dock", .map_from_dock = {{1.0, 5.6}, radians(180.0)}, .full_v = 29.0, .low_v = {}};
  return site;
}

struct Course {
  std::vector<ChargingState> states;  ///< in turn, after none at first
  std::string failure;
  double fastest_onto_mps = 0.0;  ///< on the last way, as commanded
};

/// Drives until `goes_on` says no, for six minutes at most.
Course drive(const Site& site, Charging& charging, double battery_v,
             const std::function<bool(Mission&)>& goes_on) {
  Course course;
  Stamp now;
  SimulatedDriveOptions options{.camera = site.default_camera, .goals = {}, .battery_v = battery_v};
  options.attend = [&](const SensorInput& heard, const MissionStep& step, Mission& mission) {
    now = heard.now;
    const bool is_on_last_way = !mission.finished() && mission.current() + 1 == mission.goals().size();
    if (charging.state() == ChargingState::driving && is_on_last_way)
      course.fastest_onto_mps = std::max(course.fastest_onto_mps, step.navigation.command.forward_mps);
    charging.watch(heard.now, heard.base, step, mission);
    const ChargingState before = course.states.empty() ? ChargingState::none : course.states.back();
    if (charging.state() != before) course.states.push_back(charging.state());
  };
  simulate_conducted_drive(site, options, [&](const MissionStep&, Mission& mission) {
    return now - Stamp{} < std::chrono::minutes(6) && goes_on(mission);
  });
  course.failure = charging.failure();
  return course;
}

/// Sends it to the dock, and waits for how that ends.
Course charge(const Site& site, Charging& charging, double battery_v) {
  bool has_begun = false;
  return drive(site, charging, battery_v, [&](Mission& mission) {
    if (!std::exchange(has_begun, true)) charging.begin(mission);
    return charging.is_under_way();
  });
}

TEST(ChargingInTheLab, goes_onto_the_dock_slowly_and_is_done_when_the_battery_is_full) {
  const Site site = lab_with_dock();
  Charging charging(*site.charging);
  const Course course = charge(site, charging, 27.8);
  EXPECT_EQ(course.states, (std::vector{ChargingState::driving, ChargingState::connecting,
                                        ChargingState::charging, ChargingState::full}))
      << course.failure;
  EXPECT_LE(course.fastest_onto_mps, site.charging->approach_mps + 1e-9);
  EXPECT_GT(course.fastest_onto_mps, 0.5 * site.charging->approach_mps);
}

TEST(ChargingInTheLab, a_dock_that_is_not_where_the_map_has_it_does_not_charge) {
  const Site site = lab_with_dock();
  ChargingSettings wrong = *site.charging;
  wrong.map_from_dock.position_m.x() += 0.1;
  Charging charging(wrong);
  const Course course = charge(site, charging, 25.0);
  EXPECT_EQ(course.states,
            (std::vector{ChargingState::driving, ChargingState::connecting, ChargingState::none}));
  EXPECT_THAT(course.failure, HasSubstr("V on the dock, 24.9 V before it: it does not charge"));
}

TEST(ChargingInTheLab, one_without_a_free_pose_in_front_of_it_is_not_tried_from_elsewhere) {
  Site site = lab_with_dock();
  site.charging->map_from_dock = {{3.0, 5.6}, radians(180.0)};  // the pose in front of it is in a cupboard
  Charging charging(*site.charging);
  const Course course = charge(site, charging, 25.0);
  EXPECT_EQ(course.states, (std::vector{ChargingState::driving, ChargingState::none}));
  EXPECT_EQ(course.failure, "goal occupied");
  EXPECT_EQ(course.fastest_onto_mps, 0.0);
}

TEST(ChargingInTheLab, a_low_battery_sends_it_there_once_until_somebody_has_driven_it) {
  Site site = lab_with_dock();
  site.charging->low_v = 24.0;
  ChargingSettings wrong = *site.charging;
  wrong.map_from_dock.position_m.x() += 0.1;
  Charging charging(wrong);
  const Course course = drive(site, charging, 23.5, [](Mission&) { return true; });
  EXPECT_EQ(course.states,
            (std::vector{ChargingState::driving, ChargingState::connecting, ChargingState::none}));

  Charging of_full(*site.charging);
  const Course unmoved = drive(site, of_full, 25.0, [](Mission&) { return true; });
  EXPECT_THAT(unmoved.states, IsEmpty());
}

TEST(ChargingInTheLab, ends_when_somebody_drives_the_robot_off) {
  const Site site = lab_with_dock();
  Charging charging(*site.charging);
  bool has_begun = false;
  bool has_left = false;
  const Course course = drive(site, charging, 25.0, [&](Mission& mission) {
    if (!std::exchange(has_begun, true)) charging.begin(mission);
    if (!has_left && charging.state() == ChargingState::charging) {
      mission.start({{.position_m = {2.0, 5.6}}});
      has_left = true;
    }
    return charging.state() != ChargingState::none;
  });
  EXPECT_EQ(course.states, (std::vector{ChargingState::driving, ChargingState::connecting,
                                        ChargingState::charging, ChargingState::none}));
  EXPECT_THAT(course.failure, IsEmpty());
}

TEST(ChargingInTheLab, a_dock_on_the_way_to_somewhere_else_is_driven_on_from) {
  const Site site = lab_with_dock();
  Charging charging(*site.charging);
  bool has_begun = false;
  const Course course = drive(site, charging, 25.0, [&](Mission& mission) {
    if (!std::exchange(has_begun, true)) {
      charging.begin(mission);
      mission.append({{.position_m = {2.0, 5.6}}});
    }
    return !mission.finished();
  });
  EXPECT_EQ(course.states, (std::vector{ChargingState::driving, ChargingState::none}));
  EXPECT_THAT(course.failure, IsEmpty());
}

TEST(ChargingInTheLab, a_person_may_stop_it_on_the_way) {
  const Site site = lab_with_dock();
  Charging charging(*site.charging);
  bool has_begun = false;
  const Course course = drive(site, charging, 25.0, [&](Mission& mission) {
    if (!std::exchange(has_begun, true)) charging.begin(mission);
    if (mission.phase() == MissionPhase::driving) mission.stop();
    return charging.is_under_way();
  });
  EXPECT_EQ(course.states, (std::vector{ChargingState::driving, ChargingState::none}));
  EXPECT_EQ(course.failure, "stopped by the operator");
}

}  // namespace
}  // namespace lodestar
