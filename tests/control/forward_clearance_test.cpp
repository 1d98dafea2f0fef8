#include "control/forward_clearance.hpp"

#include <gtest/gtest.h>

#include "maps/distance_field.hpp"
#include "maps/random.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

/// A hall of 4 m x 3 m in cells of 5 cm, with one pillar.
OccupancyMap hall() {
  OccupancyMap map = empty_floor(80, 60, 0.05);
  map.map_from_grid.position_m = {-1.0, -1.0};
  for (int row = 28; row < 32; ++row)
    for (int column = 50; column < 54; ++column) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  return map;
}

TEST(ForwardClearance, ends_where_the_disc_would_touch) {
  const ForwardClearance way(std::make_shared<const ObstacleField>(hall()), 0.25, 0.0);
  // The pillar begins at x = 1.5.
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, 0.0}, 3.0), 1.25, 0.011);
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, radians(180.0)}, 3.0), 0.75, 0.011) << "the edge of the map";
  EXPECT_EQ(way.ahead_m({{0.0, 0.5}, 0.0}, 0.7), 0.7) << "no farther than asked for";
  EXPECT_LT(way.ahead_m({{1.35, 0.5}, 0.0}, 1.0), 0.011) << "the footprint overlaps already";
  EXPECT_NEAR(way.ahead_m({{1.35, 0.5}, radians(180.0)}, 1.0), 1.0, 1e-9) << "driving out is free";
}

TEST(ForwardClearance, ends_earlier_where_room_must_be_spared) {
  const ForwardClearance way(std::make_shared<const ObstacleField>(hall()), 0.25, 0.0);
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, 0.0}, 3.0, {.here_m = 0.1}), 1.15, 0.011);
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, 0.0}, 3.0, {.here_m = 0.1, .per_m = 0.1}), 1.15 / 1.1, 0.011)
      << "a margin that grows per metre";
  EXPECT_NEAR(way.ahead_m({{1.2, 0.5}, radians(180.0)}, 1.0, {.here_m = 0.1}), 1.0, 1e-9)
      << "driving away from the pillar";
  EXPECT_NEAR(way.room_m({{1.2, 0.5}, 0.0}), 0.05, 1e-9);
  EXPECT_NEAR(way.room_m({{0.5, 0.5}, 0.0}), 0.75, 0.08) << "far away: a lower bound";
  EXPECT_LT(way.room_m({{1.3, 0.5}, 0.0}), 0.0);
}

TEST(ForwardClearance, never_says_more_than_is_free) {
  const OccupancyMap map = hall();
  const ForwardClearance way(std::make_shared<const ObstacleField>(map), 0.25, 0.0);
  const DistanceField distances(map);
  Random random(7);
  int ways = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose2 pose{{random.uniform(-0.5, 2.5), random.uniform(-0.5, 1.5)}, random.uniform(-3.1, 3.1)};
    const double ahead_m = way.ahead_m(pose, 2.0);
    if (ahead_m == 0.0 || way.ahead_m({pose.position_m, pose.yaw_rad + radians(180.0)}, 0.01) == 0.0)
      continue;
    ++ways;
    const Vec2 end = pose.position_m + ahead_m * Vec2(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    for (int row = 28; row < 32; ++row) {
      for (int column = 50; column < 54; ++column) {
        const Vec2 away = (end - map.center_of({column, row})).cwiseAbs().array() - 0.025;
        EXPECT_GT(away.cwiseMax(0.0).norm(), 0.25 - 1e-9);
      }
    }
  }
  EXPECT_GT(ways, 250);
}

TEST(ForwardClearance, of_a_footprint_ends_where_its_nose_would_touch) {
  // 0.5 m ahead of the origin, 0.1 m behind it, 0.3 m wide.
  const Footprint cart({{-0.1, -0.15}, {0.5, -0.15}, {0.5, 0.15}, {-0.1, 0.15}});
  const ForwardClearance way(std::make_shared<const ObstacleField>(hall()), cart, 0.0);
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, 0.0}, 3.0), 1.0, 0.03) << "the pillar begins at x = 1.5";
  EXPECT_NEAR(way.ahead_m({{0.0, 0.5}, radians(180.0)}, 3.0), 0.5, 0.03) << "the edge of the map is at -1";
  EXPECT_EQ(way.ahead_m({{0.0, 0.78}, 0.0}, 2.0), 2.0) << "passes 3 cm beside the pillar, which ends at 0.6";
  EXPECT_NEAR(way.ahead_m({{0.0, 0.72}, 0.0}, 3.0), 1.0, 0.03) << "3 cm too far over";
  EXPECT_NEAR(way.room_m({{0.8, 0.5}, 0.0}), 0.2, 0.08) << "a lower bound";
  EXPECT_NEAR(way.room_m({{0.8, 0.5}, radians(90.0)}), 0.55, 0.08);
  const ForwardClearance tolerant(std::make_shared<const ObstacleField>(hall()), cart, 0.03);
  EXPECT_EQ(tolerant.ahead_m({{0.0, 0.735}, 0.0}, 2.0), 2.0) << "smaller by the tolerance";
}

}  // namespace
}  // namespace lodestar
