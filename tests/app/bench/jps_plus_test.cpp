#include "app/bench/jps_plus.hpp"

#include <gtest/gtest.h>

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

/// From cell to cell in a diagonal and a straight part, either first.
double length_of(const std::vector<Cell>& cells) {
  double length = 0.0;
  for (std::size_t i = 1; i < cells.size(); ++i) length += free_steps(cells[i - 1], cells[i]).length_cells();
  return length;
}

TEST(JpsPlus, is_as_short_as_dijkstra_and_its_cells_lead_from_the_goal_to_the_start) {
  Random random(15);
  int found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const OccupancyMap map = random_map(random, 70, 40, random.uniform(0.0, 0.4));
    const CollisionChecker space(map, 0.0);
    const JumpTable jumps(space);
    JpsPlus search(jumps);
    for (int query = 0; query < 5; ++query) {
      const auto start = clear_cell(random, space);
      const auto goal = clear_cell(random, space);
      if (!start || !goal) break;
      const std::optional<double> length = search.find(*start, *goal);
      const double expected = dijkstra(map, space, *start, *goal);
      ASSERT_EQ(length.has_value(), expected < 1e299);
      if (!length) continue;
      ++found;
      EXPECT_NEAR(*length, expected, 1e-9);
      EXPECT_EQ(search.expanded_on_path().front(), *goal);
      EXPECT_EQ(search.expanded_on_path().back(), *start);
      EXPECT_NEAR(length_of(search.expanded_on_path()), expected, 1e-9);
    }
  }
  EXPECT_GT(found, 80);
}

}  // namespace
}  // namespace lodestar
