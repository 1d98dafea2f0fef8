#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

namespace lodestar {
namespace {

using namespace testing;

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

TEST(PoseFilter, grows_less_sure_without_fixes_but_not_while_it_stands) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  const double before = filter.estimate()->covariance.trace();
  drive(world, filter, 2.0, 2.0, false);
  const double after = filter.estimate()->covariance.trace();
  EXPECT_GT(after, 2.0 * before);
  const auto stand = [&](int from, int to) {
    for (int i = from; i <= to; ++i) {
      world.roll(0.0, 0.0, 4.0 + 0.02 * i);
      filter.add_travel(world.reported);
    }
    return filter.estimate()->covariance.trace();
  };
  const double at_rest = stand(1, 25);
  EXPECT_NEAR(at_rest, after, 0.1 * after);  // where it came to rest depends on the readings' lag
  EXPECT_DOUBLE_EQ(stand(26, 100), at_rest);
}

TEST(PoseFilter, a_flickering_encoder_does_not_make_it_drift) {
  World world;
  world.noise_m_per_sqrt_m = 0.003;
  PoseFilterOptions options = without_floor();
  options.wheel_step_m = world.wheel_step_m = 0.001;
  PoseFilter filter(options);
  drive(world, filter, 0.0, 2.0, true);
  EXPECT_FALSE(filter.standing());
  const WheelTravel rest = world.reading();
  for (int i = 1; i <= 30; ++i) filter.add_travel({at(2.0 + 0.02 * i), rest.left_m, rest.right_m});
  ASSERT_TRUE(filter.standing());
  const PoseEstimate before = *filter.estimate();
  for (int i = 31; i <= 3000; ++i)
    filter.add_travel(
        {at(2.0 + 0.02 * i), rest.left_m + 0.001 * (i % 2), rest.right_m - 0.001 * (i % 3 / 2)});
  EXPECT_EQ(filter.estimate()->map_from_base.position_m, before.map_from_base.position_m);
  EXPECT_EQ(filter.estimate()->map_from_base.yaw_rad, before.map_from_base.yaw_rad);
  EXPECT_EQ(filter.estimate()->covariance, before.covariance);
}

TEST(PoseFilter, tells_where_it_was_and_where_it_will_be_in_a_moment) {
  World world;
  PoseFilter filter(without_floor());
  EXPECT_FALSE(filter.estimate_at(at(0.0))) << "before the start";
  drive(world, filter, 0.0, 2.0, true, 1e-6, 1e-6);
  std::vector<Pose2> truth;
  for (int i = 0; i < 6; ++i) {
    world.roll(0.009, 0.011, 2.0 + 0.02 * (i + 1));
    truth.push_back(world.truth);
    if (i < 5) filter.add_travel(world.reported);
  }
  for (int i = 0; i < 6; ++i) {
    const std::optional<PoseEstimate> then = filter.estimate_at(at(2.0 + 0.02 * (i + 1)));
    ASSERT_TRUE(then);
    const Pose2& expected = truth[static_cast<std::size_t>(i)];
    EXPECT_LT((then->map_from_base.position_m - expected.position_m).norm(), 2e-4) << i;
    EXPECT_NEAR(wrap_angle(then->map_from_base.yaw_rad - expected.yaw_rad), 0.0, 1e-4) << i;
  }
  const PoseEstimate now = *filter.estimate_at(filter.estimate()->stamp);
  EXPECT_LT((now.covariance - filter.estimate()->covariance).norm(), 1e-12);
  EXPECT_GT(filter.estimate_at(at(2.12))->covariance.trace(), now.covariance.trace()) << "extrapolated";
  EXPECT_FALSE(filter.estimate_at(at(5.0)));
}

TEST(PoseFilter, tracks_a_circle_exactly_without_noise) {
  // Radius 1 m about the origin, across the wrap of the heading ten times.
  PoseFilter filter(without_floor());
  const auto on_circle = [](double angle, Stamp stamp) {
    return PlanarFix{
        .stamp = stamp,
        .map_from_base = {{std::cos(angle), std::sin(angle)}, wrap_angle(angle + 0.5 * std::numbers::pi)},
        .covariance = 1e-12 * Eigen::Matrix3d::Identity()};
  };
  double angle = 0.0;
  for (int i = 0; i <= 3000; ++i) {
    angle = 0.02 * i;
    filter.add_travel({at(0.02 * i), 0.8 * angle, 1.2 * angle});
    if (i == 10 || i == 11) filter.add_fix(on_circle(angle, at(0.02 * i)));
  }
  const Pose2 expected = on_circle(angle, Stamp{}).map_from_base;
  const Pose2 estimate = filter.estimate()->map_from_base;
  EXPECT_LT((estimate.position_m - expected.position_m).norm(), 1e-9);
  EXPECT_NEAR(wrap_angle(estimate.yaw_rad - expected.yaw_rad), 0.0, 1e-9);
  EXPECT_LE(std::abs(estimate.yaw_rad), std::numbers::pi);
}

TEST(PoseFilter, learns_a_track_width_that_is_not_as_built) {
  World world;
  world.turn_scale = 0.99;
  PoseFilter filter(without_floor());
  for (int i = 1; i <= 1000; ++i) {  // turns on the spot, back and forth
    const double way = i % 400 < 200 ? 0.005 : -0.005;
    world.roll(-way, way, 0.02 * i);
    filter.add_travel(world.reading());
    if (i % 5 == 0) filter.add_fix(world.fix(0.002, 0.002));
  }
  drive(world, filter, 20.0, 10.0, true);
  EXPECT_NEAR(filter.turn_scale(), 0.99, 0.003);
  EXPECT_NEAR(filter.wheel_scales().mean(), 1.0, 0.002);
}

TEST(PoseFilter, rounded_wheel_readings_do_not_add_up) {
  World exact;
  World rounded;
  rounded.wheel_step_m = 0.001;
  PoseFilterOptions options = without_floor();
  options.initial_wheel_scale_sigma = options.initial_turn_scale_sigma = 0.0;  // nothing to be learned
  options.wheel_scale_drift_per_sqrt_m = 0.0;
  PoseFilter by_exact(options);
  PoseFilter by_rounded(options);
  drive(exact, by_exact, 0.0, 0.4, true, 1e-6, 1e-6);
  drive(rounded, by_rounded, 0.0, 0.4, true, 1e-6, 1e-6);
  for (int leg = 0; leg < 20; ++leg) {  // 20 m without a fix
    drive(exact, by_exact, 0.4 + 2.0 * leg, 2.0, false);
    drive(rounded, by_rounded, 0.4 + 2.0 * leg, 2.0, false);
    const Pose2 difference =
        inverse(by_exact.estimate()->map_from_base) * by_rounded.estimate()->map_from_base;
    EXPECT_LE(std::abs(difference.yaw_rad), 2.0 * 0.001 / track_m) << "after " << leg + 1 << " m";
    EXPECT_LT(difference.position_m.norm(), 0.001 + 0.002 * (leg + 1)) << "after " << leg + 1 << " m";
  }
}

TEST(PoseFilter, standing_still_it_is_never_surer_than_the_survey) {
  World world;
  PoseFilterOptions options;
  options.track_width_m = track_m;
  PoseFilter filter(options);
  drive(world, filter, 0.0, 4.0, true, 0.003, 0.003);
  for (int i = 1; i <= 3000; ++i) {
    world.roll(0.0, 0.0, 4.0 + 0.02 * i);
    filter.add_travel(world.reading());
    filter.add_fix(world.fix(0.003, 0.003));
  }
  const PoseEstimate estimate = *filter.estimate();
  EXPECT_GT(std::sqrt(estimate.covariance(0, 0)), 0.5 * options.fix_sigma_floor_m);
  EXPECT_GT(std::sqrt(estimate.covariance(2, 2)), 0.5 * options.fix_sigma_floor_rad);
  EXPECT_LT(position_error(world, filter), 0.002) << "a minute of fixes averages their noise out";
}

TEST(PoseFilter, covariance_stays_symmetric_and_positive) {
  World world;
  world.noise_m_per_sqrt_m = 0.003;
  PoseFilter filter;
  for (int leg = 0; leg < 50; ++leg) {
    drive(world, filter, 4.0 * leg, 4.0, leg % 3 != 2, 1e-4, 1e-4);
    const Eigen::Matrix3d covariance = filter.estimate()->covariance;
    EXPECT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(covariance).info(), Eigen::Success);
  }
}

TEST(PoseFilter, stamps_its_estimate_with_the_wheels_and_the_newest_fix) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 1.0, true);
  const PlanarFix older = world.fix(0.002, 0.002);
  drive(world, filter, 1.0, 0.1, true);  // with a fix at 1.1 s
  drive(world, filter, 1.1, 0.06, false);
  EXPECT_EQ(filter.add_fix(older), FixOutcome::accepted);
  EXPECT_EQ(filter.estimate()->last_fix, at(1.1));
  EXPECT_EQ(filter.estimate()->stamp, world.reported.stamp);
  filter.add_travel({at(0.5), 100.0, 0.0});
  EXPECT_EQ(filter.estimate()->stamp, world.reported.stamp) << "readings from the past are ignored";
}

/// Mean NEES of independent drives: six seconds with fixes, then one without.
double mean_nees(int runs, double bias_sigma_m, double bias_sigma_rad, double wheel_step_m,
                 double sway_s = 0.0, bool fixes_tell_bias = false) {
  double sum = 0.0;
  for (int run = 1; run <= runs; ++run) {
    PoseFilterOptions options = without_floor();
    if (!fixes_tell_bias) {
      options.fix_sigma_floor_m = bias_sigma_m;
      options.fix_sigma_floor_rad = bias_sigma_rad;
    }
    options.wheel_step_m = wheel_step_m;
    options.wheel_scale_drift_per_sqrt_m = 0.0;
    options.fix_correlation = from_seconds(sway_s);
    World world;
    world.random = Random(static_cast<std::uint64_t>(run));
    world.noise_m_per_sqrt_m = options.wheel_noise_m_per_sqrt_m;
    world.scales =
        Vec2::Ones() + options.initial_wheel_scale_sigma * Vec2(world.random.normal(), world.random.normal());
    world.turn_scale = 1.0 + options.initial_turn_scale_sigma * world.random.normal();
    world.wheel_step_m = wheel_step_m;
    world.sway_s = sway_s;
    world.last_fix = at(-100.0);
    world.bias_sigma_m = bias_sigma_m;
    world.bias_sigma_rad = bias_sigma_rad;
    world.bias = world.fresh_bias();
    world.fixes_tell_bias = fixes_tell_bias;
    PoseFilter filter(options);
    drive(world, filter, 0.0, 6.0, true, 0.003, 0.003);
    drive(world, filter, 6.0, 1.0, false);
    sum += nees(world, filter);
  }
  return sum / runs;
}

TEST(PoseFilter, is_as_sure_as_it_may_be) {
  // The tolerance is the 95 % interval of a mean of chi-square values with 3 degrees of freedom.
  constexpr int runs = 300;
  const double band = 1.96 * std::sqrt(6.0 / runs);
  EXPECT_NEAR(mean_nees(runs, 0.0, 0.0, 0.0), 3.0, band);
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.0), 3.0, band) << "fixes share an error";
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.0, 0.0, true), 3.0, band) << "and state it";
  // At constant speed, the rounding of successive readings is correlated; the filter takes it as independent.
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.001), 3.0, 2.0 * band) << "and readings are rounded";
  EXPECT_NEAR(mean_nees(runs, 0.0, 0.0, 0.0, 0.25), 3.0, 2.0 * band) << "the errors of fixes change slowly";
}

}  // namespace
}  // namespace lodestar
