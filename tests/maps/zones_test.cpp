#include "maps/zones.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "maps/random.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

std::size_t occupied(const OccupancyMap& map) {
  return static_cast<std::size_t>(std::ranges::count(map.cells, OccupancyMap::occupied));
}

TEST(KeepOut, occupies_the_cells_that_it_covers_in_part_and_no_other) {
  const OccupancyMap map = empty_floor(10, 10, 0.5);
  //  On the lines of the grid: 2 x 2 cells. A little over them on all sides: 4 x 4.
  const std::vector<KeepOut> square{{"", {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}}}};
  const std::vector<KeepOut> wider{{"", {{0.99, 0.99}, {0.99, 2.01}, {2.01, 2.01}, {2.01, 0.99}}}};
  EXPECT_EQ(occupied(with_keep_out(map, square)), 4U);
  EXPECT_EQ(occupied(with_keep_out(map, wider)), 16U);
  EXPECT_EQ(with_keep_out(map, square).at({2, 2}), OccupancyMap::occupied);
  EXPECT_EQ(with_keep_out(map, {}).cells, map.cells);
}

TEST(KeepOut, of_any_shape_and_sense_covers_all_of_itself_on_a_turned_map) {
  OccupancyMap map = empty_floor(60, 40, 0.1);
  map.map_from_grid = {{-1.0, 2.0}, radians(30.0)};
  // A U, open upwards.
  Polygon corners_m{{0.0, 3.0}, {2.0, 3.0}, {2.0, 5.0}, {1.5, 5.0},
                    {1.5, 3.5}, {0.5, 3.5}, {0.5, 5.0}, {0.0, 5.0}};
  for (int sense = 0; sense < 2; ++sense) {
    const std::vector<KeepOut> zones{{"U", corners_m}};
    const OccupancyMap kept = with_keep_out(map, zones);
    Random random(7);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec2 point_m(-1.0 + 4.0 * random.uniform(), 2.0 + 4.0 * random.uniform());
      const Cell cell = map.cell_at(point_m);
      if (!map.contains(cell)) continue;
      const double distance_m = distance_to(corners_m, point_m);
      if (distance_m == 0.0) {
        ++inside;
        EXPECT_EQ(kept.at(cell), OccupancyMap::occupied) << point_m.transpose();
      }
      // No farther than a cell's diagonal.
      if (distance_m > 0.1415) {
        EXPECT_EQ(kept.at(cell), OccupancyMap::free) << point_m.transpose();
      }
    }
    EXPECT_GT(inside, 1000);
    std::ranges::reverse(corners_m);
  }
}

TEST(KeepOut, may_reach_beyond_the_map) {
  const OccupancyMap map = empty_floor(10, 10, 0.5);
  const std::vector<KeepOut> half{{"", {{-1e5, -1e5}, {2.5, -1e5}, {2.5, 1e5}, {-1e5, 1e5}}}};
  const std::vector<KeepOut> beside{{"", {{20.0, 0.0}, {30.0, 0.0}, {30.0, 5.0}}}};
  EXPECT_EQ(occupied(with_keep_out(map, half)), 50U);
  EXPECT_EQ(occupied(with_keep_out(map, beside)), 0U);
}

TEST(DistanceToPolygon, is_0_inside_and_to_the_nearest_edge_or_corner_outside) {
  const Polygon triangle{{0.0, 0.0}, {4.0, 0.0}, {0.0, 3.0}};
  EXPECT_EQ(distance_to(triangle, {1.0, 1.0}), 0.0);
  EXPECT_DOUBLE_EQ(distance_to(triangle, {2.0, -1.5}), 1.5);
  EXPECT_DOUBLE_EQ(distance_to(triangle, {7.0, -4.0}), 5.0);
  EXPECT_NEAR(distance_to(triangle, {4.0, 3.0}), 2.4, 1e-12);  // the hypotenuse: 3 x + 4 y = 12
}

}  // namespace
}  // namespace lodestar
