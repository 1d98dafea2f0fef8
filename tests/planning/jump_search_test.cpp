#include "planning/jump_search.hpp"

#include <gtest/gtest.h>

#include "maps/movingai_file.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

/// Random maps of several densities, wider than the 64 cells of a word, each with its collision checker.
template <typename Story>
void on_random_maps(std::uint64_t seed, int trials, Story story) {
  Random random(seed);
  for (int trial = 0; trial < trials; ++trial) {
    const int columns = 1 + static_cast<int>(random.below(150));
    const int rows = 1 + static_cast<int>(random.below(40));
    const OccupancyMap map = random_map(random, columns, rows, random.uniform(0.0, 0.4));
    const CollisionChecker space(map, 0.0);
    story(random, map, space);
  }
}

TEST(JumpTable, jumps_as_far_as_a_scan_of_the_bits_in_every_direction) {
  on_random_maps(11, 60, [](Random&, const OccupancyMap& map, const CollisionChecker& space) {
    const JumpTable table(space);
    const JumpScan scan(space);
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const Cell cell{column, row};
        if (!space.at(cell)) continue;
        ASSERT_EQ(table.neighbours(cell), scan.neighbours(cell));
        for (int k = 0; k < 8; ++k)
          ASSERT_EQ(table.jump(cell, k), scan.jump(cell, k)) << column << "," << row;
      }
    }
  });
}

template <typename Jumps>
void expect_as_short_as_dijkstra(std::uint64_t seed) {
  int found = 0;
  on_random_maps(seed, 60, [&](Random& random, const OccupancyMap& map, const CollisionChecker& space) {
    const Jumps jumps(space);
    JumpSearch<Jumps> search(jumps);
    for (int query = 0; query < 5; ++query) {
      const auto start = clear_cell(random, space);
      const auto goal = clear_cell(random, space);
      if (!start || !goal) return;
      const auto path = search.find(*start, *goal);
      const double expected = dijkstra(map, space, *start, *goal);
      ASSERT_EQ(path.has_value(), expected < 1e299);
      if (!path) continue;
      ++found;
      EXPECT_NEAR(path->steps.length_cells(), expected, 1e-9);
    }
  });
  EXPECT_GT(found, 80);
}

TEST(JumpSearch, is_as_short_as_dijkstra_with_a_table) {
  expect_as_short_as_dijkstra<JumpTable>(12);
}

TEST(JumpSearch, is_as_short_as_dijkstra_with_scanning) {
  expect_as_short_as_dijkstra<JumpScan>(13);
}

TEST(JumpSearch, gives_a_path_of_straight_and_diagonal_legs_that_cut_no_corner) {
  int paths = 0;
  on_random_maps(14, 40, [&](Random& random, const OccupancyMap&, const CollisionChecker& space) {
    const JumpTable jumps(space);
    JumpSearch search(jumps);
    const auto start = clear_cell(random, space);
    const auto goal = clear_cell(random, space);
    const auto path = start && goal ? search.find(*start, *goal) : std::nullopt;
    if (!path) return;
    EXPECT_EQ(path->turns.front(), *start);
    EXPECT_EQ(path->turns.back(), *goal);
    StepCount counted;
    for (std::size_t i = 1; i < path->turns.size(); ++i) {
      const Cell step =
          grid_steps[static_cast<std::size_t>(direction_between(path->turns[i - 1], path->turns[i]))];
      for (Cell at = path->turns[i - 1]; at != path->turns[i];) {
        EXPECT_TRUE(space.at({at.column + step.column, at.row}) && space.at({at.column, at.row + step.row}));
        at = {at.column + step.column, at.row + step.row};
        ASSERT_TRUE(space.at(at));
        ++(step.column != 0 && step.row != 0 ? counted.diagonal : counted.straight);
      }
    }
    EXPECT_EQ(counted.straight, path->steps.straight);
    EXPECT_EQ(counted.diagonal, path->steps.diagonal);
    ++paths;
  });
  EXPECT_GT(paths, 10);
}

TEST(JumpSearch, counts_steps_so_that_the_length_is_exact_on_a_very_long_way) {
  std::vector<std::string> rows(2, std::string(40000, '.'));
  const OccupancyMap map = map_from(rows);
  const CollisionChecker space(map, 0.0);
  const JumpTable jumps(space);
  const auto path = JumpSearch(jumps).find({0, 0}, {39999, 1});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->steps.straight, 39998);
  EXPECT_EQ(path->steps.diagonal, 1);
}

TEST(JumpSearch, has_a_path_of_no_steps_to_where_it_stands) {
  const OccupancyMap map = map_from({"..", ".."});
  const CollisionChecker space(map, 0.0);
  const JumpTable jumps(space);
  const auto path = JumpSearch(jumps).find({1, 1}, {1, 1});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->steps.length_cells(), 0.0);
}

/// The benchmark set of Sturtevant (2012); skipped where its files are absent.
TEST(JumpSearch, answers_every_query_of_the_benchmark_scenarios_optimally) {
  namespace fs = std::filesystem;
  const fs::path data = fs::path(LODESTAR_SOURCE_DIR) / "../shared/data/movingai";
  if (!fs::exists(data)) GTEST_SKIP() << "no MovingAI maps";
  for (const std::string name : {"Berlin_0_256", "den520d", "arena2", "maze512-32-0"}) {
    const OccupancyMap map = load_movingai_map(data / (name + ".map"));
    const CollisionChecker space(map, 0.0);
    const JumpTable jumps(space);
    JumpSearch search(jumps);
    for (const MovingAiQuery& query : load_movingai_queries(data / (name + ".map.scen"), map)) {
      const auto path = search.find(query.start, query.goal);
      ASSERT_TRUE(path);
      EXPECT_NEAR(path->steps.length_cells(), query.expected_length, std::max(1e-3, query.rounding));
    }
  }
}

}  // namespace
}  // namespace lodestar
