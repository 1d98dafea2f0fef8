#include "planning/turn_merging.hpp"

#include <gtest/gtest.h>

#include "planning/jump_search.hpp"
#include "planning/path_shortening.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

/// Grid coordinates in cells of 0.1 m.
PathCost travel_time(const OccupancyMap& map, const CellCosts& costs) {
  return {map, costs, MotionLimits{}};
}

TEST(TurnMerging, makes_one_turn_of_two_behind_an_obstacle) {
  std::vector<std::string> rows(20, std::string(20, '.'));
  for (std::size_t row = 8; row < 12; ++row) rows[row][9] = rows[row][10] = '#';
  const OccupancyMap map = map_from(rows);
  const CollisionChecker space(map, 0.1 * map.resolution_m);
  const CellCosts no_costs;
  const PathCost cost = travel_time(map, no_costs);
  const std::vector<Vec2> two{{2.0, 10.0}, {8.0, 14.0}, {12.0, 14.0}, {18.0, 10.0}};
  const std::vector<Vec2> one = with_turns_merged(two, {}, space, cost).points;
  ASSERT_EQ(one.size(), 3U);
  EXPECT_EQ(one.front(), two.front());
  EXPECT_EQ(one.back(), two.back());
  EXPECT_LT(cost.path(one, {}), cost.path(two, {}));
}

TEST(TurnMerging, keeps_both_turns_where_one_would_lie_in_an_obstacle) {
  // One turn would lie far above the box, beyond the wall.
  std::vector<std::string> rows(20, std::string(20, '.'));
  for (std::size_t row = 8; row < 12; ++row) rows[row][9] = rows[row][10] = '#';
  for (std::size_t column = 0; column < 20; ++column) rows[4][column] = '#';
  const OccupancyMap map = map_from(rows);
  const CollisionChecker space(map, 0.9 * map.resolution_m);
  const CellCosts no_costs;
  const std::vector<Vec2> two{{6.5, 2.0}, {6.5, 13.5}, {13.5, 13.5}, {13.5, 2.0}};
  EXPECT_EQ(with_turns_merged(two, {}, space, travel_time(map, no_costs)).points, two);
}

TEST(TurnMerging, never_makes_a_path_slower_or_touch_an_obstacle) {
  Random random(41);
  int fewer = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const OccupancyMap map = random_map(random, 60, 50, 0.03);
    const CollisionChecker space(map, 0.6 * map.resolution_m);
    const JumpScan scan(space);
    JumpSearch<JumpScan> search(scan);
    const Cell start{3, 3};
    const Cell goal{56, 46};
    if (!space.at(start) || !space.at(goal)) continue;
    const std::optional<JumpPath> found = search.find(start, goal);
    if (!found) continue;
    std::vector<Vec2> before;
    for (const Cell cell : found->turns) before.push_back(center_of(cell));
    before = pulled_tight(before, space);
    const CellCosts no_costs;
    const PathCost cost = travel_time(map, no_costs);
    const EndHeadings headings{.start_rad = 0.5, .goal_rad = -1.0};
    const std::vector<Vec2> after = with_turns_merged(before, headings, space, cost).points;
    EXPECT_EQ(after.front(), before.front());
    EXPECT_EQ(after.back(), before.back());
    EXPECT_LE(cost.path(after, headings), cost.path(before, headings));
    for (std::size_t i = 1; i < after.size(); ++i) EXPECT_TRUE(space.along(after[i - 1], after[i]));
    if (after.size() < before.size()) ++fewer;
  }
  EXPECT_GT(fewer, 10);
}

}  // namespace
}  // namespace lodestar
