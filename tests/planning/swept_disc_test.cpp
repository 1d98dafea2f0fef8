#include "planning/swept_disc.hpp"

#include <gtest/gtest.h>

#include "maps/random.hpp"
#include "maps/segment.hpp"
#include "planning/collision_checker.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

/// Extents in x of the capsule's part between two heights, by many of its points.
std::pair<double, double> sampled_extent(const Vec2& from, const Vec2& to, double radius, double low,
                                         double high) {
  constexpr int samples = 400;
  std::pair<double, double> extent{1e9, -1e9};
  for (int along = 0; along <= samples; ++along) {
    const Vec2 center = from + (to - from) * (static_cast<double>(along) / samples);
    for (int k = 0; k <= samples; ++k) {
      const double y = low + (high - low) * k / samples;
      const double up = y - center.y();
      if (std::abs(up) > radius) continue;
      const double across = std::sqrt(radius * radius - up * up);
      extent.first = std::min(extent.first, center.x() - across);
      extent.second = std::max(extent.second, center.x() + across);
    }
  }
  return extent;
}

TEST(SweptDisc, has_the_extents_of_all_its_points) {
  Random random(7);
  int compared = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const double radius = random.uniform(0.3, 4.0);
    const Vec2 from(random.uniform(0.0, 12.0), random.uniform(0.0, 12.0));
    Vec2 to(random.uniform(0.0, 12.0), random.uniform(0.0, 12.0));
    if (trial % 10 == 0) to.x() = from.x();
    if (trial % 10 == 1) to.y() = from.y();
    if (trial % 10 == 2) to = from;
    const SweptDisc swept(from, to, radius);
    const int row = static_cast<int>(random.uniform(swept.lowest_y(), swept.highest_y()));
    if (row < swept.lowest_y() || row + 1 > swept.highest_y()) continue;
    const auto [least, greatest] = sampled_extent(from, to, radius, row, row + 1);
    EXPECT_NEAR(swept.least_x(row, row + 1), least, 0.02) << trial;
    EXPECT_NEAR(swept.greatest_x(row, row + 1), greatest, 0.02) << trial;
    ++compared;
  }
  EXPECT_GT(compared, 80);
}

TEST(CollisionChecker, names_an_obstacle_that_the_leg_overlaps) {
  Random random(8);
  int blocked = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const OccupancyMap map = random_map(random, 40, 30, 0.02);
    const CollisionChecker space(map, 0.1);
    const Vec2 from(random.uniform(3.0, 37.0), random.uniform(3.0, 27.0));
    const Vec2 to(random.uniform(3.0, 37.0), random.uniform(3.0, 27.0));
    std::optional<Cell> blocking;
    const bool clear = space.along(from, to, blocking);
    EXPECT_EQ(clear, space.along(from, to));
    EXPECT_FALSE(clear && space.is_surely_blocked(from, to));
    if (!blocking) continue;
    ++blocked;
    EXPECT_FALSE(clear);
    EXPECT_FALSE(is_drivable(map.at(*blocking)));
    EXPECT_TRUE(space.is_blocked_by(*blocking, from, to));
  }
  EXPECT_GT(blocked, 50);
}

TEST(CollisionChecker, goes_as_far_as_it_stays_clear) {
  Random random(9);
  double lost_cells = 0.0;
  int count = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const OccupancyMap map = random_map(random, 60, 60, 0.01);
    const CollisionChecker space(map, 0.12);
    const Vec2 from(random.uniform(3.0, 57.0), random.uniform(3.0, 57.0));
    const double heading_rad = random.uniform(-3.1, 3.1);
    const Vec2 direction(std::cos(heading_rad), std::sin(heading_rad));
    const double length = space.clear_length(from, direction);
    if (length == 0.0) continue;
    EXPECT_TRUE(space.along(from, from + length * direction)) << trial;
    double farther = length;
    while (space.along(from, from + (farther + 0.05) * direction)) farther += 0.05;
    lost_cells += farther - length;
    ++count;
    EXPECT_LT(farther - length, 1.0 + space.radius_cells()) << trial;
  }
  ASSERT_GT(count, 300);
  EXPECT_LT(lost_cells / count, 1.5);
}

}  // namespace
}  // namespace lodestar
