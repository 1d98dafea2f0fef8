#include <deque>
#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

namespace lodestar {
namespace {

using namespace testing;

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

TEST(PoseFilter, moves_a_little_only_when_two_markers_say_so) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  const Pose2 before = filter.estimate()->map_from_base;
  const auto displaced_fix = [&](int id) {
    PlanarFix fix = world.fix(0.002, 0.002);
    fix.map_from_base.position_m.x() += 0.3;
    fix.ids = {id};
    return fix;
  };
  for (int i = 0; i < 50; ++i) EXPECT_EQ(filter.add_fix(displaced_fix(7)), FixOutcome::refused_gate);
  EXPECT_EQ(filter.estimate()->map_from_base.position_m, before.position_m) << "that marker may have moved";
  EXPECT_EQ(filter.add_fix(displaced_fix(8)), FixOutcome::relocated);
  EXPECT_NEAR(filter.estimate()->map_from_base.position_m.x(), before.position_m.x() + 0.3, 0.01);
}

TEST(PoseFilter, moves_far_when_one_marker_says_so_often_enough) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  world.truth.position_m.x() += 3.0;
  const auto fix = [&] {
    PlanarFix by_one_marker = world.fix(0.002, 0.002);
    by_one_marker.ids = {7};
    return by_one_marker;
  };
  for (int i = 1; i < 5; ++i) EXPECT_EQ(filter.add_fix(fix()), FixOutcome::refused_gate);
  EXPECT_EQ(filter.add_fix(fix()), FixOutcome::relocated);
}

TEST(PoseFilter, tells_what_it_expects_of_a_fix) {
  World world;
  PoseFilter filter(without_floor());
  EXPECT_FALSE(filter.expectation(world.fix(0.002, 0.002))) << "before the start";
  drive(world, filter, 0.0, 2.0, true);
  PlanarFix fix = world.fix(1e-4, 1e-4);
  EXPECT_TRUE(filter.expectation(fix)->agrees);
  fix.map_from_base.position_m.y() += 0.1;
  const FixExpectation expected = *filter.expectation(fix);
  EXPECT_FALSE(expected.agrees);
  EXPECT_NEAR(fix.map_from_base.position_m.y() - expected.map_from_base.position_m.y(), 0.1, 0.005);
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
  EXPECT_GT(filter.estimate_at(at(2.12))->covariance.trace(), now.covariance.trace()) << "guessed ahead";
  EXPECT_FALSE(filter.estimate_at(at(5.0)));
}

TEST(PoseFilter, tracks_a_circle_exactly_without_noise) {
  // Radius 1 m about the origin, ten times across the seam of the heading.
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
  for (int i = 1; i <= 1000; ++i) {  // turns on the spot, to and fro
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

TEST(PoseFilter, late_fixes_end_like_prompt_ones) {
  World world;
  PoseFilter prompt(without_floor());
  PoseFilter late(without_floor());
  std::deque<PlanarFix> on_the_way;
  for (int i = 1; i <= 500; ++i) {
    world.roll(0.010, 0.011, 0.02 * i);
    prompt.add_travel(world.reported);
    late.add_travel(world.reported);
    if (i % 5 == 0 && i <= 490) {
      on_the_way.push_back(world.fix(0.002, 0.002));
      prompt.add_fix(on_the_way.back());
    }
    if (i % 5 == 4 && !on_the_way.empty()) {  // 80 ms late
      late.add_fix(on_the_way.front());
      on_the_way.pop_front();
    }
  }
  EXPECT_TRUE(on_the_way.empty());
  const PoseEstimate a = *prompt.estimate();
  const PoseEstimate b = *late.estimate();
  EXPECT_LT((a.map_from_base.position_m - b.map_from_base.position_m).norm(), 1e-9);
  EXPECT_LT((a.covariance - b.covariance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(a.last_fix, b.last_fix);
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

TEST(PoseFilter, takes_a_fix_a_little_ahead_of_the_wheels_but_not_far) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  for (int i = 1; i <= 10; ++i) world.roll(0.010, 0.010, 2.0 + 0.02 * i);
  EXPECT_EQ(filter.add_fix(world.fix(0.002, 0.002)), FixOutcome::refused_late) << "0.2 s";
  World ahead;
  PoseFilter waiting(without_floor());
  drive(ahead, waiting, 0.0, 2.0, true);
  const WheelTravel before = ahead.reported;
  ahead.roll(0.010, 0.010, 2.02);
  EXPECT_EQ(waiting.add_fix(ahead.fix(1e-4, 1e-4)), FixOutcome::accepted);
  EXPECT_EQ(waiting.estimate()->stamp, before.stamp);
  EXPECT_EQ(waiting.estimate()->last_fix, at(2.02));
  waiting.add_travel(ahead.reported);
  EXPECT_LT(position_error(ahead, waiting), 0.002);
}

/// Mean NEES of independent drives: six seconds under markers, then one without.
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
  // The band is that of the 95 % limits of a mean of chi-square values with 3 degrees of freedom.
  constexpr int runs = 300;
  const double band = 1.96 * std::sqrt(6.0 / runs);
  EXPECT_NEAR(mean_nees(runs, 0.0, 0.0, 0.0), 3.0, band);
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.0), 3.0, band) << "fixes share an error";
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.0, 0.0, true), 3.0, band) << "and say by how much";
  // At a steady pace the rounding of one reading resembles that of the next, which the filter takes for new.
  EXPECT_NEAR(mean_nees(runs, 0.003, 0.002, 0.001), 3.0, 2.0 * band) << "and readings are rounded";
  EXPECT_NEAR(mean_nees(runs, 0.0, 0.0, 0.0, 0.25), 3.0, 2.0 * band) << "the errors of fixes change slowly";
}

}  // namespace
}  // namespace lodestar
