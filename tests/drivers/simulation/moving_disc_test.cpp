#include "drivers/simulation/moving_disc.hpp"

#include <gtest/gtest.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using std::chrono::seconds;

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

// From (1, 1) east for 2 s at 1 m/s, then north for 1 s at 2 m/s.
MovingDisc walker(bool loops) {
  return {.radius_m = 0.25,
          .trajectory = {{{seconds(1), {1, 1}}, {seconds(3), {3, 1}}, {seconds(4), {3, 3}}}, loops}};
}

TEST(MovingDisc, stands_before_its_first_key_and_after_its_last) {
  FollowedTrajectory disc(walker(false));
  EXPECT_EQ(disc.at(at(0.0)).position_m, Vec2(1, 1));
  EXPECT_TRUE(disc.at(at(0.9)).velocity_mps.isZero());
  EXPECT_TRUE(disc.at(at(2.5)).position_m.isApprox(Vec2(2.5, 1)));
  EXPECT_TRUE(disc.at(at(3.5)).position_m.isApprox(Vec2(3, 2)));
  EXPECT_TRUE(disc.at(at(3.5)).velocity_mps.isApprox(Vec2(0, 2)));
  EXPECT_EQ(disc.at(at(9.0)).position_m, Vec2(3, 3));
  EXPECT_TRUE(disc.at(at(9.0)).velocity_mps.isZero());
}

TEST(MovingDisc, begins_again_when_it_loops) {
  FollowedTrajectory disc(walker(true));
  EXPECT_EQ(disc.at(at(0.5)).position_m, Vec2(1, 1)) << "before the first key it stands all the same";
  EXPECT_TRUE(disc.at(at(4.0)).position_m.isApprox(Vec2(1, 1)))
      << "the last key is the first of the next round";
  EXPECT_TRUE(disc.at(at(5.5)).position_m.isApprox(Vec2(2.5, 1)));
  EXPECT_TRUE(disc.at(at(1.0 + 3.0 * 1000 + 2.5)).position_m.isApprox(Vec2(3, 2)));
}

TEST(MovingDisc, with_one_key_stands_for_ever) {
  FollowedTrajectory disc(MovingDisc{.trajectory = {{{seconds(0), {2, 5}}}, true}});
  EXPECT_EQ(disc.at(at(0.0)).position_m, Vec2(2, 5));
  EXPECT_EQ(disc.at(at(1000.0)).position_m, Vec2(2, 5));
}

TEST(MovingDisc, refuses_a_way_without_keys_or_back_in_time) {
  EXPECT_THROW(FollowedTrajectory(MovingDisc{}), InputError);
  EXPECT_THROW(
      FollowedTrajectory(MovingDisc{.trajectory = {{{seconds(1), {1, 1}}, {seconds(1), {2, 1}}}, false}}),
      InputError);
}

TEST(MovingDisc, is_seen_as_itself_or_as_two_legs_below_itself) {
  std::vector<VisibleDisc> seen;
  append_visible({.radius_m = 0.4, .position_m = {1, 2}}, seen);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].radius_m, 0.4);

  MovingDisc person = walker(false);
  person.has_legs = true;
  FollowedTrajectory way(person);
  double widest_m = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const DiscState state = way.at(at(0.01 * i));
    seen.clear();
    append_visible(state, seen);
    ASSERT_EQ(seen.size(), 2U);
    for (const VisibleDisc& leg : seen) {
      EXPECT_EQ(leg.radius_m, 0.06);
      EXPECT_LE((leg.center_m - state.position_m).norm() + leg.radius_m, person.radius_m + 1e-9);
    }
    const Vec2 apart = seen[0].center_m - seen[1].center_m;
    if (!state.velocity_mps.isZero())
      widest_m = std::max(widest_m, std::abs(apart.dot(state.velocity_mps.normalized())));
  }
  EXPECT_GT(widest_m, 0.3) << "in a stride one leg is well ahead of the other";
}

TEST(MovingDisc, moves_its_legs_as_fast_as_they_say) {
  MovingDisc person = walker(false);
  person.has_legs = true;
  FollowedTrajectory way(person);
  std::vector<VisibleDisc> before;
  std::vector<VisibleDisc> after;
  (void)way.at(at(1.9));
  append_visible(way.at(at(2.000)), before);
  append_visible(way.at(at(2.001)), after);
  for (const int leg : {0, 1}) {
    const Vec2 speed_mps =
        (after[static_cast<std::size_t>(leg)].center_m - before[static_cast<std::size_t>(leg)].center_m) /
        0.001;
    EXPECT_LT((speed_mps - before[static_cast<std::size_t>(leg)].velocity_mps).norm(), 0.02) << "leg " << leg;
  }
}

}  // namespace
}  // namespace lodestar
