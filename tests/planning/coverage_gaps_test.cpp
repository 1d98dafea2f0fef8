#include "planning/coverage_gaps.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr double resolution_m = 0.1;

OccupancyMap free_room(int columns, int rows) {
  OccupancyMap map;
  map.columns = columns;
  map.rows = rows;
  map.resolution_m = resolution_m;
  map.cells.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), OccupancyMap::free);
  return map;
}

TEST(LanesThroughGaps, cover_the_floor_that_lanes_leave_out) {
  const CollisionChecker checker(free_room(60, 40), 0.2);
  std::vector<bool> floor(60U * 40U, false);
  for (int row = 5; row < 35; ++row)
    for (int column = 5; column < 55; ++column) floor[checker.map().index({column, row})] = true;
  const std::vector<Lane> lanes = lanes_through_gaps(
      checker, floor, {{checker.map().center_of({5, 5}), checker.map().center_of({54, 5})}}, 1.0);
  ASSERT_FALSE(lanes.empty());
  EXPECT_LT(lanes.size(), 6U) << "3 m, 2 m at a time";
  EXPECT_GT(lanes.front().from_m.y(), 1.5) << "not where one is driven already";
}

/// No lane reaches the floor: no place there is clear of obstacles by the robot's radius.
TEST(LanesThroughGaps, come_to_an_end_where_nothing_reaches_the_floor) {
  OccupancyMap map = free_room(12, 12);
  for (int row = 0; row < 12; ++row) map.cells[map.index({0, row})] = OccupancyMap::occupied;
  const CollisionChecker checker(map, 5.0);
  std::vector<bool> floor(12U * 12U, false);
  for (int row = 4; row < 8; ++row)
    for (int column = 4; column < 8; ++column) floor[map.index({column, row})] = true;
  EXPECT_LE(lanes_through_gaps(checker, floor, {}, 0.5).size(), 16U);
}

}  // namespace
}  // namespace lodestar
