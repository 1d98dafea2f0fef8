#include "localization/filter/zero_velocity_detector.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr double step_m = 0.001;

Stamp at(int step) {
  return Stamp(from_seconds(0.02 * step));
}

TEST(ZeroVelocityDetector, holds_wheels_whose_encoders_flicker) {
  ZeroVelocityDetector detector(step_m);
  WheelTravel settled;
  for (int i = 0; i < 500; ++i) {
    settled = detector.settled({at(i), 1.0 + step_m * (i % 2), 2.0});
    EXPECT_EQ(detector.standing(), i >= 15) << i;
    if (i < 15) continue;
    EXPECT_EQ(settled.left_m, 1.001) << "held since the wheel stopped";
    EXPECT_EQ(settled.stamp, at(i)) << "time goes on";
  }
}

TEST(ZeroVelocityDetector, lets_slow_travel_through) {
  // 0.1 mm per reading, 5 mm/s, reported in steps of 1 mm.
  ZeroVelocityDetector detector(step_m);
  for (int i = 0; i < 1000; ++i) {
    const double reported_m = step_m * std::floor(0.1 * i);
    const WheelTravel settled = detector.settled({at(i), reported_m, reported_m});
    EXPECT_NEAR(settled.left_m, reported_m, 1.01 * step_m);
  }
  EXPECT_EQ(detector.settled({at(1000), 0.200, 0.200}).left_m, 0.200);
}

TEST(ZeroVelocityDetector, ends_with_the_first_real_travel) {
  ZeroVelocityDetector detector(step_m);
  for (int i = 0; i < 100; ++i) detector.settled({at(i), 0.0, 0.0});
  ASSERT_TRUE(detector.standing());
  const WheelTravel settled = detector.settled({at(100), 0.002, -0.002});
  EXPECT_FALSE(detector.standing());
  EXPECT_EQ(settled.left_m, 0.002);
  EXPECT_EQ(settled.right_m, -0.002);
}

}  // namespace
}  // namespace lodestar
