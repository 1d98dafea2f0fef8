#include "planning/coverage_lanes.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr double resolution_m = 0.1;

/// 12 x 8 m, with a wall between x = 6 and 6.2 m that has a door at its upper end, and beyond x = 10 m a room
/// without any.
OccupancyMap two_rooms_and_a_closed_one() {
  OccupancyMap map;
  map.columns = 120;
  map.rows = 80;
  map.resolution_m = resolution_m;
  map.cells.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                   OccupancyMap::free);
  for (int row = 0; row < map.rows; ++row)
    for (const int column : {60, 61, 100})
      if (column == 100 || row < 65) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  return map;
}

double distance_m(const Lane& lane, const Vec2& point) {
  const Vec2 way = lane.to_m - lane.from_m;
  const double share = std::clamp((point - lane.from_m).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (lane.from_m + share * way - point).norm();
}

class CoverageLanes : public testing::Test {
 protected:
  CollisionChecker clear{two_rooms_and_a_closed_one(), 0.3};
  CoverageLanesOptions options{.spacing_m = 1.5};
  std::vector<Lane> lanes = coverage_lanes(clear, clear, {1.0, 1.0}, options);
};

TEST_F(CoverageLanes, pass_every_reachable_place_both_ways_within_half_their_spacing) {
  for (int row = 8; row < 72; row += 4) {
    for (int column = 8; column < 92; column += 4) {
      if (column > 52 && column < 70) continue;  // beside the wall
      const Vec2 place = clear.map().center_of({column, row});
      const auto passes = [&](bool along_row) {
        return std::ranges::any_of(lanes, [&](const Lane& lane) {
          const bool is_row = std::abs(lane.to_m.y() - lane.from_m.y()) < 1e-9;
          return is_row == along_row && distance_m(lane, place) <= 0.5 * options.spacing_m + resolution_m;
        });
      };
      EXPECT_TRUE(passes(true) && passes(false)) << place.transpose();
    }
  }
}

TEST_F(CoverageLanes, are_clear_and_on_this_side_of_closed_walls) {
  ASSERT_FALSE(lanes.empty());
  for (const Lane& lane : lanes) {
    EXPECT_LT(std::max(lane.from_m.x(), lane.to_m.x()), 10.0);
    EXPECT_TRUE(clear.along(lane.from_m / resolution_m, lane.to_m / resolution_m));
    EXPECT_LE((lane.to_m - lane.from_m).norm(), options.longest_m + resolution_m);
  }
}

TEST_F(CoverageLanes, go_on_behind_a_door_that_is_too_narrow_for_a_lane) {
  OccupancyMap map = two_rooms_and_a_closed_one();
  for (int row = 72; row < 80; ++row)
    for (const int column : {60, 61}) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  const auto is_behind = [](const Lane& lane) { return lane.from_m.x() > 6.2; };
  const CollisionChecker roomy(map, 0.45);
  const CollisionChecker passable(map, 0.3);
  EXPECT_FALSE(std::ranges::any_of(coverage_lanes(roomy, roomy, {1.0, 1.0}), is_behind)) << "0.7 m of door";
  EXPECT_TRUE(std::ranges::any_of(coverage_lanes(roomy, passable, {1.0, 1.0}), is_behind));
}

/// A room of 2 x 1 m of free floor beside a hall, between the hall's rows and columns.
TEST_F(CoverageLanes, go_into_rooms_that_the_pattern_misses) {
  OccupancyMap map = two_rooms_and_a_closed_one();
  for (int row = 0; row < map.rows; ++row)
    for (int column = 70; column < 100; ++column)
      if (row < 30 || row > 40) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  for (int shift = 0; shift < 12; ++shift) {
    OccupancyMap shifted = map;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 70; column < 100; ++column)
        shifted.cells[map.index({column, row})] = map.cells[map.index({column, (row + shift) % map.rows})];
    const CollisionChecker checker(shifted, 0.3);
    EXPECT_TRUE(std::ranges::any_of(coverage_lanes(checker, checker, {1.0, 1.0}, options),
                                    [](const Lane& lane) { return lane.to_m.x() > 8.0; }))
        << "shifted by " << shift << " cells";
  }
}

TEST_F(CoverageLanes, are_none_where_the_start_has_no_room) {
  EXPECT_TRUE(coverage_lanes(clear, clear, {6.1, 2.0}, options).empty());
}

}  // namespace
}  // namespace lodestar
