#include "control/backtrack.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(Backtrack, leads_to_a_place_well_before_the_last_with_a_marker_in_view) {
  Backtrack backtrack({.before_last_m = 0.8});
  for (int centimetre = 0; centimetre <= 300; ++centimetre) backtrack.saw_marker_at({0.01 * centimetre, 1.0});
  const std::optional<Vec2> place_m = backtrack.begin();
  ASSERT_TRUE(place_m);
  EXPECT_NEAR(place_m->x(), 3.0 - 0.8, 0.15);
  EXPECT_EQ(place_m->y(), 1.0);
}

TEST(Backtrack, is_not_made_for_ever_nor_to_nowhere) {
  Backtrack backtrack({.most_to_a_goal = 2});
  EXPECT_FALSE(backtrack.begin()) << "no marker was ever seen";
  backtrack.saw_marker_at(Vec2::Zero());
  EXPECT_TRUE(backtrack.begin());
  EXPECT_FALSE(backtrack.begin()) << "no marker since";
  backtrack.saw_marker_at(Vec2::Zero());
  EXPECT_TRUE(backtrack.begin());
  backtrack.saw_marker_at(Vec2::Zero());
  EXPECT_FALSE(backtrack.begin()) << "at most two to a goal";
  backtrack.new_goal();
  EXPECT_TRUE(backtrack.begin());
}

TEST(Backtrack, was_in_vain_when_no_marker_is_seen_where_it_led_to) {
  Backtrack backtrack;
  backtrack.saw_marker_at(Vec2::Zero());
  backtrack.begin();
  EXPECT_FALSE(backtrack.found_no_marker()) << "it has not arrived there yet";
  backtrack.reached_place();
  EXPECT_TRUE(backtrack.found_no_marker());
  backtrack.saw_marker_at(Vec2::Zero());
  EXPECT_FALSE(backtrack.found_no_marker());
  backtrack.begin();
  backtrack.saw_marker_at(Vec2::Zero());
  backtrack.reached_place();
  EXPECT_FALSE(backtrack.found_no_marker());
}

TEST(Backtrack, remembers_where_it_saw_nothing_until_it_sees_something_there) {
  Backtrack backtrack;
  backtrack.saw_no_marker_at({-1.0, 0.0});
  backtrack.saw_marker_at({0.0, 0.0});
  for (int centimetre = 0; centimetre <= 100; ++centimetre)
    backtrack.saw_no_marker_at({0.01 * centimetre, 0.0});
  EXPECT_TRUE(backtrack.blind_places_m().empty()) << "no backtrack from there yet";
  ASSERT_TRUE(backtrack.begin());
  EXPECT_NEAR(static_cast<double>(backtrack.blind_places_m().size()), 11.0, 1.0);
  backtrack.saw_marker_at({0.5, 0.0});
  for (const Vec2& blind_m : backtrack.blind_places_m()) EXPECT_GT(std::abs(blind_m.x() - 0.5), 0.09);
  backtrack.new_goal();
  EXPECT_FALSE(backtrack.blind_places_m().empty());
}

TEST(Backtrack, knows_a_marker_on_the_way_from_the_one_at_its_end) {
  Backtrack backtrack({.markers_view_m = 1.5});
  EXPECT_FALSE(backtrack.possible());
  backtrack.saw_marker_at(Vec2::Zero());
  ASSERT_TRUE(backtrack.possible());
  ASSERT_TRUE(backtrack.begin());
  EXPECT_TRUE(backtrack.is_far_from_its_end({0.0, 4.0}));
  EXPECT_FALSE(backtrack.is_far_from_its_end({0.0, 1.0}));
}

}  // namespace
}  // namespace lodestar
