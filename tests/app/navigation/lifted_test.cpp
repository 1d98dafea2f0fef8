#include <gtest/gtest.h>
#include <set>

#include "tests/app/navigation/lab.hpp"

// Nobody moved a marker: lifting the robot and putting it back must accuse none.
namespace lodestar {
namespace {

constexpr int seen_when_lifted = 447;

/// Two markers are in view from where the robot stands, and only a third from 0.6 m ahead of there.
Lab sparse_lab() {
  Lab lab;
  lab.site.start = {{5.0, 2.0}, 0.0};
  const double z_m = lab.site.registry.markers.front().position_m.z();
  lab.known.registry.markers = {{.id = 1782, .position_m = {3.8, 2.3, z_m}},
                                {.id = 3003, .position_m = {3.8, 1.7, z_m}},
                                {.id = seen_when_lifted, .position_m = {6.6, 2.0, z_m}}};
  lab.installed = lab.known.registry;
  return lab;
}

class Lifted : public testing::Test {
 protected:
  void stand(double duration_s) {
    const Stamp end = simulation.now() + from_seconds(duration_s);
    while (simulation.now() < end) {
      SensorInput input = sense(lab, simulation, base);
      for (WheelTravel& travel : input.base.travel) {
        travel.left_m += pushed_m;
        travel.right_m += pushed_m;
      }
      step = navigation.step(input);
      for (const FixAttempt& fix : step.fixes) {
        seen.insert(fix.fix.ids.begin(), fix.fix.ids.end());
        if (fix.outcome == FixOutcome::refused_gate) ++contradictions;
      }
    }
  }

  void push(double by_m) { simulation.push({{by_m, 0.0}, 0.0}); }

  Lab lab = sparse_lab();
  Simulation simulation = lab.simulation();
  BaseDriver base{simulation.can()};
  Navigation navigation{lab.known, navigation_options(lab.site.robot)};
  NavigationStep step;
  std::set<int> seen;
  int contradictions = 0;
  double pushed_m = 0.0;  ///< travel that the wheels report beside their own
};

TEST_F(Lifted, and_put_back_accuses_no_marker) {
  stand(3.0);
  ASSERT_EQ(seen, (std::set<int>{1782, 3003}));
  push(0.6);
  stand(2.0);
  ASSERT_TRUE(seen.contains(seen_when_lifted));
  ASSERT_GE(contradictions, 6);
  push(-0.6);
  stand(3.0);
  EXPECT_TRUE(step.distrusted.empty());
}

TEST_F(Lifted, rolled_and_placed_by_the_operator_accuses_no_marker) {
  stand(3.0);
  push(0.6);
  pushed_m = 0.05;  // somebody also rolled it a little
  stand(2.0);
  ASSERT_GE(contradictions, 6);
  push(-0.6);
  ASSERT_TRUE(navigation.place_robot(lab.site.start));
  stand(3.0);
  EXPECT_TRUE(step.distrusted.empty());
}

}  // namespace
}  // namespace lodestar
