#include "localization/survey/wheel_segment.hpp"

#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

Stamp at(double t_s) {
  return Stamp(from_seconds(t_s));
}

/// A quarter turn on the spot, then a metre ahead: 50 readings a second.
std::vector<WheelTravel> turn_and_straight(double track_m) {
  std::vector<WheelTravel> readings{{at(0.0), 0.0, 0.0}};
  const double rim_m = 0.25 * std::numbers::pi * track_m;  // a quarter turn's
  for (int i = 1; i <= 50; ++i) readings.push_back({at(0.02 * i), -rim_m * i / 50.0, rim_m * i / 50.0});
  for (int i = 1; i <= 50; ++i) readings.push_back({at(1.0 + 0.02 * i), -rim_m + i / 50.0, rim_m + i / 50.0});
  return readings;
}

TEST(WheelSegment, composes_a_turn_and_a_straight_as_they_were) {
  const std::vector<WheelTravel> readings = turn_and_straight(0.4);
  const auto segment = WheelSegment::between(readings, at(0.0), at(2.0));
  ASSERT_TRUE(segment);
  const WheelMotion motion = segment->motion({.track_m = 0.4});
  EXPECT_NEAR(motion.turn_rad, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(motion.way_m.x(), 0.0, 1e-12);  // a single arc would end at (0.64, 0.64)
  EXPECT_NEAR(motion.way_m.y(), 1.0, 1e-12);
}

TEST(WheelSegment, derivatives_are_those_of_differences) {
  const std::vector<WheelTravel> readings = turn_and_straight(0.4);
  const auto segment = WheelSegment::between(readings, at(0.31), at(1.77));
  ASSERT_TRUE(segment);
  const WheelGauge gauge{.difference = 0.012, .track_m = 0.41};
  constexpr double step = 1e-6;
  const WheelMotion here = segment->motion(gauge);
  for (int k = 0; k < 2; ++k) {
    WheelGauge more = gauge;
    WheelGauge less = gauge;
    (k == 0 ? more.difference : more.track_m) += step;
    (k == 0 ? less.difference : less.track_m) -= step;
    const WheelMotion after = segment->motion(more);
    const WheelMotion before = segment->motion(less);
    const Vec2 by = (after.way_m - before.way_m) / (2.0 * step);
    EXPECT_NEAR(here.by_gauge(0, k), by.x(), 1e-6);
    EXPECT_NEAR(here.by_gauge(1, k), by.y(), 1e-6);
    EXPECT_NEAR(here.by_gauge(2, k), (after.turn_rad - before.turn_rad) / (2.0 * step), 1e-6);
  }
}

TEST(WheelSegment, covariance_is_that_of_drives_with_slip) {
  const WheelNoise noise{.encoder_sigma_m = 0.0, .sideways_sigma_per_sqrt_m = 0.0};
  const WheelGauge gauge{.track_m = 0.4};
  const std::vector<WheelTravel> readings = turn_and_straight(0.4);
  const auto segment = WheelSegment::between(readings, at(0.0), at(2.0));
  const Eigen::Matrix3d expected = segment->covariance(gauge, noise);
  const WheelMotion mean = segment->motion(gauge);
  Random random(1);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int drives = 4000;
  for (int n = 0; n < drives; ++n) {
    std::vector<WheelTravel> slipped = readings;
    Vec2 off = Vec2::Zero();
    for (std::size_t i = 1; i < readings.size(); ++i) {
      off.x() += noise.slip_sigma_per_sqrt_m *
                 std::sqrt(std::abs(readings[i].left_m - readings[i - 1].left_m)) * random.normal();
      off.y() += noise.slip_sigma_per_sqrt_m *
                 std::sqrt(std::abs(readings[i].right_m - readings[i - 1].right_m)) * random.normal();
      slipped[i].left_m += off.x();
      slipped[i].right_m += off.y();
    }
    const WheelMotion motion = WheelSegment::between(slipped, at(0.0), at(2.0))->motion(gauge);
    const Vec3 error(motion.way_m.x() - mean.way_m.x(), motion.way_m.y() - mean.way_m.y(),
                     motion.turn_rad - mean.turn_rad);
    sum += error * error.transpose() / drives;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(sum(i, i), expected(i, i), 0.1 * expected(i, i));
  EXPECT_NEAR(sum(0, 2), expected(0, 2), 0.1 * std::sqrt(expected(0, 0) * expected(2, 2)));
}

TEST(WheelSegment, is_nothing_where_readings_are_missing) {
  std::vector<WheelTravel> readings = turn_and_straight(0.4);
  EXPECT_FALSE(WheelSegment::between(readings, at(-0.1), at(1.0)));
  EXPECT_FALSE(WheelSegment::between(readings, at(1.0), at(2.1)));
  readings.erase(readings.begin() + 20, readings.begin() + 60);
  EXPECT_FALSE(WheelSegment::between(readings, at(0.0), at(2.0)));
}

}  // namespace
}  // namespace lodestar
