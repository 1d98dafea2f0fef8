#include "control/spin.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

TEST(Spin, waits_turns_once_around_and_gives_up) {
  const SpinOptions options;
  Spin look(options);
  EXPECT_FALSE(look.update(at(0.0), std::nullopt, 0.0));
  double turned_rad = 5.0;
  double first_s = 0.0;
  double last_s = 0.0;
  for (int i = 1; i < 2000; ++i) {
    const std::optional<double> turn = look.update(at(0.02 * i), StopReason::pose_stale, turned_rad);
    if (!turn) continue;
    if (first_s == 0.0) first_s = 0.02 * i;
    last_s = 0.02 * i;
    turned_rad += 0.02 * *turn;
  }
  EXPECT_NEAR(first_s, 1.02, 0.021) << "after the wait";
  EXPECT_NEAR(turned_rad - 5.0, options.most_turn_rad, 0.02);
  EXPECT_LT(last_s, 19.0);
}

TEST(Spin, ends_when_a_marker_is_found_and_begins_anew_the_next_time) {
  Spin look;
  look.update(at(0.0), StopReason::pose_uncertain, 0.0);
  EXPECT_TRUE(look.update(at(1.5), StopReason::pose_uncertain, 0.0));
  EXPECT_FALSE(look.update(at(1.6), std::nullopt, 0.1));
  EXPECT_FALSE(look.update(at(1.7), StopReason::pose_uncertain, 0.1)) << "it waits again";
  EXPECT_TRUE(look.update(at(2.8), StopReason::pose_uncertain, 0.1));
}

TEST(Spin, does_not_turn_a_robot_that_may_not_or_whose_base_is_silent) {
  Spin look({.allowed = false});
  Spin silent;
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(look.update(at(0.02 * i), StopReason::pose_stale, 0.0));
    EXPECT_FALSE(silent.update(at(0.02 * i), StopReason::base_silent, 0.0));
  }
}

}  // namespace
}  // namespace lodestar
