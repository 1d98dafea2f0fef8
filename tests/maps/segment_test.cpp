#include "maps/segment.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

TEST(Segment, is_nearest_between_its_ends_or_at_one) {
  const Vec2 from(1.0, 1.0);
  const Vec2 to(4.0, 5.0);  // 5 long
  EXPECT_NEAR(distance_to_segment(from, to, {0.0, 0.0}), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(distance_to_segment(from, to, {4.0, 7.0}), 2.0, 1e-12);
  const Vec2 aside = Vec2(2.5, 3.0) + 0.5 * Vec2(-0.8, 0.6);
  EXPECT_NEAR(distance_to_segment(from, to, aside), 0.5, 1e-12);
  EXPECT_LT((nearest_on_segment(from, to, aside) - Vec2(2.5, 3.0)).norm(), 1e-12);
}

TEST(Segment, of_no_length_is_a_point) {
  EXPECT_EQ(nearest_on_segment({1.0, 2.0}, {1.0, 2.0}, {5.0, 5.0}), Vec2(1.0, 2.0));
  EXPECT_EQ(distance_to_segment({1.0, 2.0}, {1.0, 2.0}, {4.0, 6.0}), 5.0);
}

TEST(Outline, is_as_far_as_its_nearest_edge_and_negative_inside) {
  const std::vector<Vec2> ell{{0.0, 0.0}, {4.0, 0.0}, {4.0, 1.0}, {1.0, 1.0}, {1.0, 4.0}, {0.0, 4.0}};
  EXPECT_NEAR(distance_to_outline(ell, {3.0, 0.7}), -0.3, 1e-12);
  EXPECT_NEAR(distance_to_outline(ell, {0.5, 3.0}), -0.5, 1e-12);
  EXPECT_NEAR(distance_to_outline(ell, {2.0, 3.0}), 1.0, 1e-12) << "in the notch";
  EXPECT_NEAR(distance_to_outline(ell, {7.0, 5.0}), 5.0, 1e-12);
  EXPECT_NEAR(distance_to_outline(ell, {0.9, 0.9}), -std::sqrt(0.02), 1e-12);
}

}  // namespace
}  // namespace lodestar
