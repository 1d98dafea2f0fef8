#include <deque>
#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

// Which fixes the filter accepts, at what time they apply, and which it refuses.
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

TEST(PoseFilter, an_older_fix_takes_nothing_from_a_newer_one) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 1.0, true);
  const PlanarFix older = world.fix(0.02, 0.02);
  for (int i = 1; i <= 5; ++i) {
    world.roll(0.01, 0.01, 1.0 + 0.02 * i);
    filter.add_travel(world.reported);
  }
  ASSERT_EQ(filter.add_fix(world.fix(1e-5, 1e-5)), FixOutcome::accepted);
  const PoseEstimate before = *filter.estimate();
  EXPECT_EQ(filter.add_fix(older), FixOutcome::accepted);
  // Of the wheels' scales a share alone is learned, so the older fix may cost a little.
  EXPECT_LE(filter.estimate()->covariance.trace(), 1.01 * before.covariance.trace());
  EXPECT_LT((filter.estimate()->map_from_base.position_m - before.map_from_base.position_m).norm(), 1e-4);
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
  EXPECT_EQ(filter.estimate()->map_from_base.position_m, before.position_m) << "that marker may be displaced";
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

TEST(PoseFilter, takes_a_fix_a_little_ahead_of_the_wheels_but_not_far) {
  World world;
  PoseFilter filter(without_floor());
  drive(world, filter, 0.0, 2.0, true);
  for (int i = 1; i <= 10; ++i) world.roll(0.010, 0.010, 2.0 + 0.02 * i);
  EXPECT_EQ(filter.add_fix(world.fix(0.002, 0.002)), FixOutcome::refused_late) << "0.2 s ahead of the wheels";
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

}  // namespace
}  // namespace lodestar
