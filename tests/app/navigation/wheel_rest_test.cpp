#include "app/navigation/wheel_rest.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

using std::chrono::milliseconds;

/// Readings every 20 ms for that long, at this speed, in whole millimetres.
void roll(WheelRest& rest, Stamp& now, double& at_m, double speed_mps, Duration time) {
  for (const Stamp end = now + time; now < end;) {
    now += milliseconds(20);
    at_m += speed_mps * 0.02;
    const double whole_m = std::floor(1000.0 * at_m) / 1000.0;
    rest.take(std::vector<WheelTravel>{{now, whole_m, whole_m}});
  }
}

TEST(WheelRest, holds_when_the_wheels_have_stood_for_the_window) {
  WheelRest rest;
  Stamp now;
  double at_m = 0.0;
  EXPECT_FALSE(rest.holds());
  roll(rest, now, at_m, 0.1, milliseconds(500));
  EXPECT_FALSE(rest.holds());
  roll(rest, now, at_m, 0.0, milliseconds(380));
  EXPECT_FALSE(rest.holds());
  roll(rest, now, at_m, 0.0, milliseconds(100));
  EXPECT_TRUE(rest.holds());
  roll(rest, now, at_m, 0.1, milliseconds(60));
  EXPECT_FALSE(rest.holds());
}

TEST(WheelRest, does_not_hold_while_the_robot_creeps) {
  WheelRest rest;
  Stamp now;
  double at_m = 0.0;
  roll(rest, now, at_m, 0.006, milliseconds(3000));
  EXPECT_FALSE(rest.holds());
}

}  // namespace
}  // namespace lodestar
