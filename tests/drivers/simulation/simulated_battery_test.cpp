#include "drivers/simulation/simulated_battery.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr Duration minute = std::chrono::minutes(1);

double after_min(SimulatedBattery& battery, int minutes, bool drives, const Pose2& at) {
  for (int i = 0; i < minutes; ++i) battery.step(minute, drives, at);
  return battery.voltage_v();
}

/// 10 Ah between 22 and 28.8 V: an ampere-hour is 0.68 V.
TEST(SimulatedBattery, is_drained_by_what_it_feeds_and_sags_under_load) {
  SimulatedBattery battery({.start_v = 26.0});
  const Pose2 away{{3.0, 0.0}, 0.0};
  EXPECT_NEAR(after_min(battery, 60, false, away), 26.0 - 0.68 - 0.08, 1e-6);
  EXPECT_NEAR(after_min(battery, 30, true, away), 26.0 - 4 * 0.68 - 6 * 0.08, 1e-6);
}

TEST(SimulatedBattery, is_charged_where_the_contacts_touch_up_to_the_end_voltage) {
  SimulatedBattery battery({.start_v = 26.0});
  EXPECT_NEAR(after_min(battery, 1, false, {{0.031, 0.0}, 0.0}), 25.91, 0.01);
  EXPECT_NEAR(after_min(battery, 1, false, {{0.0, 0.0}, 0.1}), 25.90, 0.01);
  EXPECT_NEAR(after_min(battery, 1, false, {{0.02, 0.0}, 0.05}), 26.80, 0.02);
  EXPECT_NEAR(after_min(battery, 120, false, {}), 29.2, 0.1);
}

TEST(SimulatedBattery, is_never_emptier_than_empty) {
  SimulatedBattery battery({.start_v = 22.1});
  EXPECT_NEAR(after_min(battery, 600, true, {{3.0, 0.0}, 0.0}), 22.0 - 6 * 0.08, 1e-6);
}

}  // namespace
}  // namespace lodestar
