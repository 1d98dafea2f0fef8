#include "maps/ray_casting.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "maps/random.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

// Row 0 at the bottom, cells of 0.5 m:
//
//   2 m  . . . . . .
//        . . . . # .      # occupied, x 2.0..2.5 m, y 1.0..1.5 m
//        . ? . . . .      ? unknown,  x 0.5..1.0 m, y 0.5..1.0 m
//   0 m  . . . . . .  3 m
OccupancyMap hand_made_map() {
  OccupancyMap map = empty_floor(6, 4, 0.5);
  map.cells[map.index({4, 2})] = OccupancyMap::occupied;
  map.cells[map.index({1, 1})] = OccupancyMap::unknown;
  return map;
}

constexpr double far_away_m = 100.0;

TEST(RayCasting, measures_to_the_near_face_of_a_cell) {
  const OccupancyMap map = hand_made_map();
  EXPECT_DOUBLE_EQ(range_to_obstacle_m(map, {0.3, 1.2}, 0.0, far_away_m).value(), 1.7);
  EXPECT_DOUBLE_EQ(range_to_obstacle_m(map, {2.9, 1.2}, std::numbers::pi, far_away_m).value(), 0.4);
  EXPECT_NEAR(range_to_obstacle_m(map, {2.2, 0.2}, radians(90.0), far_away_m).value(), 0.8, 1e-12);
  EXPECT_NEAR(range_to_obstacle_m(map, {1.5, 0.5}, radians(45.0), far_away_m).value(), std::sqrt(0.5), 1e-12);
}

TEST(RayCasting, sees_through_unknown_cells_and_the_outside) {
  const OccupancyMap map = hand_made_map();
  EXPECT_FALSE(range_to_obstacle_m(map, {0.2, 0.7}, 0.0, far_away_m))
      << "only the unknown cell is in the way";
  EXPECT_DOUBLE_EQ(range_to_obstacle_m(map, {-5.0, 1.2}, 0.0, far_away_m).value(), 7.0);
  EXPECT_FALSE(range_to_obstacle_m(map, {-5.0, 1.2}, std::numbers::pi, far_away_m)) << "looks away";
  EXPECT_FALSE(range_to_obstacle_m(map, {-5.0, 9.0}, 0.0, far_away_m)) << "passes beside the map";
}

TEST(RayCasting, ends_at_its_range) {
  const OccupancyMap map = hand_made_map();
  EXPECT_TRUE(range_to_obstacle_m(map, {0.3, 1.2}, 0.0, 1.7 + 1e-9));
  EXPECT_FALSE(range_to_obstacle_m(map, {0.3, 1.2}, 0.0, 1.7 - 1e-9));
}

TEST(RayCasting, is_at_once_there_inside_an_obstacle) {
  EXPECT_EQ(range_to_obstacle_m(hand_made_map(), {2.2, 1.2}, 1.0, far_away_m).value(), 0.0);
}

TEST(RayCasting, finds_nothing_from_nowhere) {
  const OccupancyMap map = hand_made_map();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(range_to_obstacle_m(map, {nan, 1.2}, 0.0, far_away_m));
  EXPECT_FALSE(range_to_obstacle_m(map, {0.3, 1.2}, nan, far_away_m));
  EXPECT_FALSE(range_to_obstacle_m(map, {0.3, 1.2}, 0.0, nan));
  EXPECT_FALSE(range_to_obstacle_m(OccupancyMap{}, {0.3, 1.2}, 0.0, far_away_m));
}

TEST(RayCasting, knows_how_steeply_the_ray_comes_in) {
  const OccupancyMap map = hand_made_map();
  EXPECT_NEAR(cast_ray(map, {0.3, 1.2}, radians(3.0), far_away_m)->incidence_cos, std::cos(radians(3.0)),
              1e-12);
  EXPECT_NEAR(cast_ray(map, {2.2, 0.2}, radians(80.0), far_away_m)->incidence_cos, std::sin(radians(80.0)),
              1e-12);
}

/// The range to a square of side 1 with this lower corner, by its four sides.
double range_to_square(const Vec2& from, const Vec2& direction, const Vec2& low) {
  const double infinity = std::numeric_limits<double>::infinity();
  double enters = 0.0;
  double leaves = infinity;
  for (const int axis : {0, 1}) {
    const double a = (low[axis] - from[axis]) / direction[axis];
    const double b = (low[axis] + 1.0 - from[axis]) / direction[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves ? enters : infinity;
}

TEST(RayCasting, agrees_with_every_cell_tried_in_turn_on_rotated_maps) {
  Random random(7);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    OccupancyMap map = empty_floor(17, 11, 0.2);
    map.map_from_grid = {{random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)}, random.uniform(-3.0, 3.0)};
    for (std::int8_t& cell : map.cells)
      if (random.uniform() < 0.05) cell = OccupancyMap::occupied;
    const Vec2 from_in_grid(random.uniform(-1.0, 4.4), random.uniform(-1.0, 3.2));
    const double heading_rad = random.uniform(-10.0, 10.0);
    const double in_grid_rad = heading_rad - map.map_from_grid.yaw_rad;
    double nearest = std::numeric_limits<double>::infinity();
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column)
        if (map.at({column, row}) == OccupancyMap::occupied)
          nearest = std::min(
              nearest, range_to_square(from_in_grid / map.resolution_m,
                                       {std::cos(in_grid_rad), std::sin(in_grid_rad)}, Vec2(column, row)));
    const double range_m = nearest * map.resolution_m;
    const auto found = range_to_obstacle_m(map, map.map_from_grid * from_in_grid, heading_rad, 2.5);
    ASSERT_EQ(found.has_value(), range_m <= 2.5) << "trial " << trial;
    if (!found) continue;
    EXPECT_NEAR(*found, range_m, 1e-9) << "trial " << trial;
    ++hits;
  }
  EXPECT_GT(hits, 400);
}

TEST(RayCasting, meets_a_disc_on_its_near_side) {
  const Vec2 east(1.0, 0.0);
  EXPECT_DOUBLE_EQ(cast_ray_at_disc({0.0, 0.0}, east, {3.0, 0.0}, 0.5)->range_m, 2.5);
  EXPECT_DOUBLE_EQ(cast_ray_at_disc({0.0, 0.0}, east, {3.0, 0.3}, 0.5)->range_m, 2.6) << "3-4-5 triangle";
  EXPECT_DOUBLE_EQ(cast_ray_at_disc({0.0, 0.0}, east, {3.0, 0.3}, 0.5)->incidence_cos, 0.8);
  EXPECT_FALSE(cast_ray_at_disc({0.0, 0.0}, east, {3.0, 0.51}, 0.5));
  EXPECT_FALSE(cast_ray_at_disc({0.0, 0.0}, east, {-3.0, 0.0}, 0.5)) << "behind";
  EXPECT_EQ(cast_ray_at_disc({0.0, 0.0}, east, {-0.2, 0.1}, 0.5)->range_m, 0.0) << "inside";
}

TEST(RayCasting, says_what_is_in_sight) {
  const OccupancyMap map = hand_made_map();
  EXPECT_FALSE(is_in_sight(map, {1.0, 1.2}, {2.9, 1.2}));
  EXPECT_TRUE(is_in_sight(map, {1.0, 1.2}, {1.9, 1.2}));
  EXPECT_TRUE(is_in_sight(map, {1.0, 1.2}, {2.9, 0.2}));
}

}  // namespace
}  // namespace lodestar
