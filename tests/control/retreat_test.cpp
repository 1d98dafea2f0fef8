#include "control/retreat.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(Retreat, leads_to_a_place_well_before_the_last_with_a_marker_in_view) {
  Retreat retreat({.before_last_m = 0.8});
  for (int centimetre = 0; centimetre <= 300; ++centimetre) retreat.saw_marker_at({0.01 * centimetre, 1.0});
  const std::optional<Vec2> place_m = retreat.begin();
  ASSERT_TRUE(place_m);
  EXPECT_NEAR(place_m->x(), 3.0 - 0.8, 0.15);
  EXPECT_EQ(place_m->y(), 1.0);
}

TEST(Retreat, is_not_made_for_ever_nor_to_nowhere) {
  Retreat retreat({.most_to_a_goal = 2});
  EXPECT_FALSE(retreat.begin()) << "no marker was ever seen";
  retreat.saw_marker_at(Vec2::Zero());
  EXPECT_TRUE(retreat.begin());
  EXPECT_FALSE(retreat.begin()) << "no marker since";
  retreat.saw_marker_at(Vec2::Zero());
  EXPECT_TRUE(retreat.begin());
  retreat.saw_marker_at(Vec2::Zero());
  EXPECT_FALSE(retreat.begin()) << "two were made";
  retreat.new_goal();
  EXPECT_TRUE(retreat.begin());
}

TEST(Retreat, was_in_vain_when_no_marker_is_seen_where_it_led_to) {
  Retreat retreat;
  retreat.saw_marker_at(Vec2::Zero());
  retreat.begin();
  EXPECT_FALSE(retreat.was_in_vain()) << "it is still on its way";
  retreat.came_back();
  EXPECT_TRUE(retreat.was_in_vain());
  retreat.saw_marker_at(Vec2::Zero());
  EXPECT_FALSE(retreat.was_in_vain());
  retreat.begin();
  retreat.saw_marker_at(Vec2::Zero());
  retreat.came_back();
  EXPECT_FALSE(retreat.was_in_vain());
}

TEST(Retreat, remembers_where_it_saw_nothing_until_it_sees_something_there) {
  Retreat retreat;
  retreat.saw_nothing_at({-1.0, 0.0});
  retreat.saw_marker_at({0.0, 0.0});
  for (int centimetre = 0; centimetre <= 100; ++centimetre) retreat.saw_nothing_at({0.01 * centimetre, 0.0});
  EXPECT_TRUE(retreat.blind_ground_m().empty()) << "it has not failed there";
  ASSERT_TRUE(retreat.begin());
  EXPECT_NEAR(static_cast<double>(retreat.blind_ground_m().size()), 11.0, 1.0);
  retreat.saw_marker_at({0.5, 0.0});
  for (const Vec2& blind_m : retreat.blind_ground_m()) EXPECT_GT(std::abs(blind_m.x() - 0.5), 0.09);
  retreat.new_goal();
  EXPECT_FALSE(retreat.blind_ground_m().empty());
}

TEST(Retreat, knows_a_marker_on_the_way_from_the_one_at_its_end) {
  Retreat retreat({.markers_view_m = 1.5});
  EXPECT_FALSE(retreat.possible());
  retreat.saw_marker_at(Vec2::Zero());
  ASSERT_TRUE(retreat.possible());
  ASSERT_TRUE(retreat.begin());
  EXPECT_TRUE(retreat.is_far_from_its_end({0.0, 4.0}));
  EXPECT_FALSE(retreat.is_far_from_its_end({0.0, 1.0}));
}

}  // namespace
}  // namespace lodestar
