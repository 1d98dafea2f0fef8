#include "localization/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double track_m = 0.4;

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

/// A robot whose wheels roll as told, and report something slightly different.
struct World {
  Pose2 truth{{1.0, 2.0}, 0.3};
  WheelTravel reported;
  Vec2 scales = Vec2::Ones();  ///< true over reported
  double noise_m_per_sqrt_m = 0.0;
  Random random{1};

  void roll(double left_m, double right_m, double time_s) {
    reported.stamp = at(time_s);
    reported.left_m += left_m;
    reported.right_m += right_m;
    const double left =
        left_m * scales[0] + noise_m_per_sqrt_m * std::sqrt(std::abs(left_m)) * random.normal();
    const double right =
        right_m * scales[1] + noise_m_per_sqrt_m * std::sqrt(std::abs(right_m)) * random.normal();
    const double turn = (right - left) / track_m;
    const double direction = truth.yaw_rad + 0.5 * turn;
    truth.position_m += 0.5 * (left + right) * Vec2(std::cos(direction), std::sin(direction));
    truth.yaw_rad = wrap_angle(truth.yaw_rad + turn);
  }

  PlanarFix fix(double sigma_m, double sigma_rad) {
    PlanarFix result{.stamp = reported.stamp, .map_from_base = truth};
    result.map_from_base.position_m += sigma_m * Vec2(random.normal(), random.normal());
    result.map_from_base.yaw_rad += sigma_rad * random.normal();
    result.covariance = Vec3(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
    return result;
  }
};

PoseFilterOptions without_floor() {
  PoseFilterOptions options;
  options.track_width_m = track_m;
  options.fix_sigma_floor_m = 0.0;
  options.fix_sigma_floor_rad = 0.0;
  return options;
}

/// Drives for a while at 50 Hz along a lazy S, with a fix every fifth step while `sees`.
void drive(World& world, PoseFilter& filter, double from_s, double for_s, bool sees, double sigma_m = 0.002,
           double sigma_rad = 0.002) {
  const int steps = static_cast<int>(std::lround(for_s * 50.0));
  for (int i = 1; i <= steps; ++i) {
    const double time_s = from_s + 0.02 * i;
    const double bend = 0.001 * std::sin(0.5 * time_s);
    world.roll(0.01 - bend, 0.01 + bend, time_s);
    filter.add_travel(world.reported);
    if (sees && i % 5 == 0) filter.add_fix(world.fix(sigma_m, sigma_rad));
  }
}

double position_error(const World& world, const PoseFilter& filter) {
  return (filter.estimate()->map_from_base.position_m - world.truth.position_m).norm();
}

TEST(PoseFilter, knows_nothing_before_two_fixes_agree) {
  World world;
  PoseFilter filter(without_floor());
  EXPECT_FALSE(filter.estimate());
  drive(world, filter, 0.0, 0.2, false);
  EXPECT_EQ(filter.add_fix(world.fix(0.001, 0.001)), FixOutcome::collecting);
  EXPECT_FALSE(filter.estimate());
  drive(world, filter, 0.2, 0.2, false);
  PlanarFix elsewhere = world.fix(0.001, 0.001);
  elsewhere.map_from_base.position_m.x() += 1.0;
  EXPECT_EQ(filter.add_fix(elsewhere), FixOutcome::collecting) << "it contradicts the first one";
  drive(world, filter, 0.4, 0.2, false);
  EXPECT_EQ(filter.add_fix(world.fix(0.001, 0.001)), FixOutcome::collecting)
      << "it contradicts the second one";
  drive(world, filter, 0.6, 0.2, false);
  EXPECT_EQ(filter.add_fix(world.fix(0.001, 0.001)), FixOutcome::started);
  ASSERT_TRUE(filter.estimate());
  EXPECT_LT(position_error(world, filter), 0.01);
}

TEST(PoseFilter, follows_perfect_wheels_exactly) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 1.0, true, 1e-6, 1e-6);
  drive(world, filter, 1.0, 10.0, false);
  EXPECT_LT(position_error(world, filter), 1e-3);
}

TEST(PoseFilter, learns_unequal_wheels_and_bridges_a_gap_with_them) {
  World world;
  world.scales = {1.006, 0.994};
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 20.0, true);
  EXPECT_NEAR(filter.wheel_scales()[0], 1.006, 0.002);
  EXPECT_NEAR(filter.wheel_scales()[1], 0.994, 0.002);
  drive(world, filter, 20.0, 3.0, false);  // 1.5 m without a marker
  EXPECT_LT(position_error(world, filter), 0.01);
}

TEST(PoseFilter, applies_a_late_fix_at_its_capture_time) {
  World world;
  PoseFilter prompt(without_floor());
  drive(world, prompt, 0.0, 1.0, true);
  PoseFilter late = prompt;
  const PlanarFix fix = world.fix(0.002, 0.002);
  prompt.add_fix(fix);
  for (int i = 1; i <= 5; ++i) {
    world.roll(0.01, 0.01, 1.0 + 0.02 * i);
    prompt.add_travel(world.reported);
    late.add_travel(world.reported);
  }
  EXPECT_EQ(late.add_fix(fix), FixOutcome::accepted);
  EXPECT_LT((late.estimate()->map_from_base.position_m - prompt.estimate()->map_from_base.position_m).norm(),
            1e-12);
  EXPECT_LT((late.estimate()->covariance - prompt.estimate()->covariance).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(PoseFilter, places_a_fix_between_two_wheel_readings) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 1.0, true);
  PlanarFix between = world.fix(1e-5, 1e-5);
  world.roll(0.02, 0.02, 1.04);
  filter.add_travel(world.reported);
  between.stamp = at(1.02);
  between.map_from_base.position_m = 0.5 * (between.map_from_base.position_m + world.truth.position_m);
  EXPECT_EQ(filter.add_fix(between), FixOutcome::accepted);
  EXPECT_LT(position_error(world, filter), 1e-3);
}

TEST(PoseFilter, refuses_an_outlier_and_a_fix_from_too_long_ago) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  const Pose2 before = filter.estimate()->map_from_base;
  PlanarFix outlier = world.fix(0.002, 0.002);
  outlier.map_from_base.position_m.y() += 0.2;
  EXPECT_EQ(filter.add_fix(outlier), FixOutcome::refused_gate);
  EXPECT_EQ(filter.estimate()->map_from_base.position_m, before.position_m);
  PlanarFix old = world.fix(0.002, 0.002);
  old.stamp = at(0.1);
  EXPECT_EQ(filter.add_fix(old), FixOutcome::refused_late);
}

TEST(PoseFilter, finds_itself_again_after_being_carried_away) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 5.0, true);
  world.truth.position_m += Vec2(2.0, -1.0);
  world.truth.yaw_rad = wrap_angle(world.truth.yaw_rad + 1.5);
  FixOutcome last = FixOutcome::accepted;
  for (int i = 1; i <= 5; ++i) {
    world.roll(0.01, 0.01, 5.0 + 0.02 * i);
    filter.add_travel(world.reported);
    last = filter.add_fix(world.fix(0.002, 0.002));
    if (i < 5) {
      EXPECT_EQ(last, FixOutcome::refused_gate);
    }
  }
  EXPECT_EQ(last, FixOutcome::relocated);
  EXPECT_LT(position_error(world, filter), 0.01);
}

TEST(PoseFilter, grows_less_sure_without_fixes_but_not_while_it_stands) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  const double before = filter.estimate()->covariance.trace();
  drive(world, filter, 2.0, 2.0, false);
  const double after = filter.estimate()->covariance.trace();
  EXPECT_GT(after, 2.0 * before);
  for (int i = 1; i <= 100; ++i) {
    world.roll(0.0, 0.0, 4.0 + 0.02 * i);
    filter.add_travel(world.reported);
  }
  EXPECT_DOUBLE_EQ(filter.estimate()->covariance.trace(), after);
}

TEST(PoseFilter, is_as_sure_as_it_may_be) {
  // Mean NEES of 3 degrees of freedom over independent drives; the band is that of its 95 % limits.
  constexpr int runs = 300;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    PoseFilterOptions options = without_floor();
    World world;
    world.random = Random(seed);
    world.noise_m_per_sqrt_m = options.wheel_noise_m_per_sqrt_m;
    world.scales =
        Vec2::Ones() + options.initial_wheel_scale_sigma * Vec2(world.random.normal(), world.random.normal());
    options.wheel_scale_drift_per_sqrt_m = 0.0;
    PoseFilter filter(options);
    drive(world, filter, 0.0, 6.0, true, 0.003, 0.003);
    drive(world, filter, 6.0, 1.0, false);
    const PoseEstimate estimate = *filter.estimate();
    Vec3 error;
    error << world.truth.position_m - estimate.map_from_base.position_m,
        wrap_angle(world.truth.yaw_rad - estimate.map_from_base.yaw_rad);
    nees += error.dot(estimate.covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(nees / runs, 3.0, 1.96 * std::sqrt(6.0 / runs));
}

}  // namespace
}  // namespace lodestar
