#include <gtest/gtest.h>

#include "tests/app/navigation/lab.hpp"

namespace lodestar {
namespace {

/// The robot stands under marker 447. Marker 1782 hangs twice, 3 m ahead, and nowhere near its registered
/// place.
Lab lab_with_twins() {
  Lab lab;
  lab.site.start = {{5.0, 2.0}, 0.0};
  const double z_m = lab.site.registry.markers.front().position_m.z();
  lab.installed.markers = {{.id = 447, .position_m = {5.2, 2.2, z_m}},
                           {.id = 1782, .position_m = {8.0, 2.4, z_m}},
                           {.id = 1782, .position_m = {8.3, 1.8, z_m}}};
  lab.known.registry.markers = {{.id = 447, .position_m = {5.2, 2.2, z_m}},
                                {.id = 1782, .position_m = {12.0, 6.0, z_m}}};
  return lab;
}

struct Robot {
  explicit Robot(Lab there) : lab(std::move(there)) {}

  void stand(double duration_s) {
    const Stamp end = simulation.now() + from_seconds(duration_s);
    while (simulation.now() < end) {
      step = navigation.step(sense(lab, simulation, base));
      for (const FixAttempt& fix : step.fixes)
        has_relocated = has_relocated || fix.outcome == FixOutcome::relocated;
    }
  }

  Lab lab;
  Simulation simulation = lab.simulation();
  BaseDriver base{simulation.can()};
  Navigation navigation{lab.known, navigation_options(lab.site.robot)};
  NavigationStep step;
  bool has_relocated = false;
};

/// Carried off to where it saw two of an ID and used neither, a robot drove on (campaign mission 4667).
TEST(SeenTwice, where_neither_is_expected_says_that_the_robot_is_elsewhere) {
  Robot robot(lab_with_twins());
  robot.stand(2.0);
  ASSERT_FALSE(robot.step.stop);
  robot.simulation.push({{3.0, 0.0}, 0.0});
  robot.stand(1.0);
  EXPECT_EQ(robot.step.stop, StopReason::contradicted);
  EXPECT_FALSE(robot.has_relocated) << "which of them tells where is unknown";
}

TEST(SeenTwice, where_one_of_them_is_expected_says_nothing) {
  Lab lab = lab_with_twins();
  RegisteredMarker twin = lab.installed.markers.front();
  twin.position_m += Vec3(0.3, -0.5, 0.0);
  lab.installed.markers.push_back(twin);
  Robot robot(std::move(lab));
  robot.stand(0.5);
  ASSERT_TRUE(robot.navigation.place_robot(robot.lab.site.start));
  robot.stand(3.0);
  EXPECT_NE(robot.step.stop, StopReason::contradicted);
}

}  // namespace
}  // namespace lodestar
