#include <gtest/gtest.h>

#include "app/navigation/mission.hpp"
#include "maps/random.hpp"

#include "tests/app/navigation/lab.hpp"

// When a mission counts as arrived, and what it says when it never does.
namespace lodestar {
namespace {

struct Drive {
  bool arrived = false;
  std::string failure;
  double estimated_error_m = 0.0;  ///< distance of the estimate from the goal, at the end
  double time_s = 0.0;
};

using Disturb = std::function<void(BaseFeedback&, Simulation&)>;

/// Half a metre ahead in the lab. `disturb` changes what the base reports, and where it is.
Drive drive(const NavigationOptions& options, const Disturb& disturb) {
  const Lab lab;
  Simulation simulation = lab.simulation();
  BaseDriver base(simulation.can());
  const Vec2 goal_m = lab.site.start * Vec2(0.5, 0.0);
  Mission mission(lab.known, options, {{goal_m, std::nullopt}});
  Drive result;
  while (!mission.finished() && result.time_s < 120.0) {
    SensorInput input = sense(lab, simulation, base);
    disturb(input.base, simulation);
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);
    result.arrived = result.arrived || step.event == MissionEvent::goal_arrived;
    if (step.navigation.estimate)
      result.estimated_error_m = (step.navigation.estimate->map_from_base.position_m - goal_m).norm();
    result.time_s += seconds(period);
  }
  result.failure = mission.failure();
  return result;
}

const Disturb nothing = [](BaseFeedback&, Simulation&) {};

TEST(Arrival, needs_no_speed_free_of_noise) {
  Random random(7);
  const Drive result = drive(navigation_options(lab().robot), [&](BaseFeedback& base, Simulation&) {
    if (!base.measured) return;
    base.measured->forward_mps += 0.005 * random.normal();
    base.measured->turn_radps += 0.005 * random.normal();
  });
  EXPECT_TRUE(result.arrived) << result.failure;
  EXPECT_LT(result.time_s, 20.0);
}

TEST(Arrival, of_a_base_that_never_rests_ends_with_a_reason) {
  // It rocks to and fro by 3 mm from when it drives.
  constexpr double rate_radps = 12.0;
  double time_s = 0.0;
  double swing_m = 0.0;
  const Drive result =
      drive(navigation_options(lab().robot), [&](BaseFeedback& base, Simulation& simulation) {
        time_s += seconds(period);
        if (time_s < 2.0) return;
        const double before_m = swing_m;
        swing_m = 0.003 * std::sin(rate_radps * (time_s - 2.0));
        simulation.push({{swing_m - before_m, 0.0}, 0.0});
        if (base.measured) base.measured->forward_mps += (swing_m - before_m) / seconds(period);
        for (WheelTravel& travel : base.travel) {
          travel.left_m += swing_m;
          travel.right_m += swing_m;
        }
      });
  EXPECT_FALSE(result.arrived);
  EXPECT_NE(result.failure.find("does not come to rest"), std::string::npos) << result.failure;
  EXPECT_LT(result.time_s, 60.0);
}

TEST(Arrival, is_only_within_the_robots_epsilon) {
  NavigationOptions options = navigation_options(lab().robot);
  for (const double epsilon_m : {0.0002, 0.001, 0.01}) {
    options.drive.arrival_distance_m = epsilon_m;
    const Drive result = drive(options, nothing);
    if (result.arrived) {
      EXPECT_LE(result.estimated_error_m, epsilon_m);
    } else {
      EXPECT_NE(result.failure.find("not reached"), std::string::npos) << result.failure;
    }
    EXPECT_TRUE(result.arrived || epsilon_m < 0.01) << result.failure;
  }
}

}  // namespace
}  // namespace lodestar
