#include "maps/obstacle_field.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <tuple>

#include "maps/distance_field.hpp"
#include "planning/collision_checker.hpp"
#include "planning/grid_search.hpp"
#include "planning/jump_search.hpp"
#include "planning/tile_distances.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

TEST(ObstacleField, has_the_exact_distances_up_to_its_range) {
  Random random(31);
  for (const auto& [columns, rows, share] : {std::tuple(70, 50, 0.1), std::tuple(64, 30, 0.01),
                                             std::tuple(129, 40, 0.3), std::tuple(600, 580, 0.0)}) {
    const OccupancyMap map = random_map(random, columns, rows, share);
    const ObstacleField field(map);
    const DistanceField exact(map);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int expected = std::min<int>(exact.squared_cells({column, row}), ObstacleField::far);
        ASSERT_EQ(field.squared_cells(map.index({column, row})), expected) << column << ", " << row;
      }
    }
  }
}

/// Labels by flood fill.
std::vector<int> flooded(const CollisionChecker& space) {
  const OccupancyMap& map = space.map();
  std::vector<int> labels(map.cells.size(), 0);
  int label = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto columns = static_cast<std::size_t>(map.columns);
    std::vector<Cell> open{{static_cast<int>(i % columns), static_cast<int>(i / columns)}};
    if (labels[i] != 0 || !space.at(open.back())) continue;
    labels[i] = ++label;
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      for (const Cell next : {Cell{cell.column + 1, cell.row}, Cell{cell.column - 1, cell.row},
                              Cell{cell.column, cell.row + 1}, Cell{cell.column, cell.row - 1}}) {
        if (!space.at(next) || labels[map.index(next)] != 0) continue;
        labels[map.index(next)] = label;
        open.push_back(next);
      }
    }
  }
  return labels;
}

TEST(Regions, are_those_of_a_flood_fill) {
  Random random(32);
  for (int trial = 0; trial < 30; ++trial) {
    const OccupancyMap map =
        random_map(random, 40 + 13 * (trial % 5), 30 + trial, trial % 2 == 0 ? 0.3 : 0.02);
    const CollisionChecker space(map, 0.05 * (trial % 4));
    const std::vector<int> expected = flooded(space);
    std::map<int, int> label_of;  // a one-to-one match of labels
    std::map<int, int> back;
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const int label = space.region({column, row});
        const int other = expected[map.index({column, row})];
        ASSERT_EQ(label_of.try_emplace(label, other).first->second, other);
        ASSERT_EQ(back.try_emplace(other, label).first->second, label);
      }
    }
    EXPECT_EQ(label_of.contains(0), std::ranges::count(expected, 0) > 0);
  }
}

TEST(TileDistances, reach_the_whole_region_and_are_hardly_longer_than_paths_over_cells) {
  Random random(33);
  int compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const OccupancyMap map = random_map(random, 90, 70, 0.03);
    const CollisionChecker space(map, 0.08 + 0.03 * (trial % 4));
    const std::optional<Cell> from = clear_cell(random, space);
    if (!from) continue;
    const TileMap tiles(space);
    ASSERT_GT(tiles.side_cells(), 1);
    TileDistances distances(tiles);
    distances.measure(*from, 1e6, tiles.size());
    for (int i = 0; i < 20; ++i) {
      const Cell to = clear_cell(random, space).value();
      if (space.region(to) != space.region(*from)) continue;
      const std::optional<double> over_tiles = distances.at(tiles.tile_at(center_of(to)));
      ASSERT_TRUE(over_tiles.has_value());
      EXPECT_LT(*over_tiles, 1.02 * dijkstra(map, space, *from, to) + 3.0 * tiles.side_cells());
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

/// As wide as the robot: its centre has to pass on the border between two cells.
TEST(TileDistances, go_through_a_gap_that_no_cell_s_centre_is_clear_in) {
  std::vector<std::string> rows(40, std::string(60, '.'));
  for (std::size_t row = 0; row < 40; ++row)
    if (row < 18 || row >= 22) rows[row][30] = '#';
  const OccupancyMap map = map_from(rows, 0.05);
  const CollisionChecker space(map, 0.1);
  ASSERT_TRUE(space.along({20.0, 20.0}, {40.0, 20.0}));
  ASSERT_NE(space.region({20, 20}), space.region({40, 20}));
  const TileMap tiles(space);
  TileDistances distances(tiles);
  distances.measure({20, 20}, 1e6, tiles.size());
  EXPECT_TRUE(distances.at(tiles.tile_at({40.0, 20.0})).has_value());
}

TEST(TileDistances, go_around_walls) {
  std::vector<std::string> rows(40, std::string(60, '.'));
  for (std::size_t row = 0; row < 38; ++row) rows[row][30] = '#';
  const OccupancyMap map = map_from(rows, 0.05);
  const CollisionChecker space(map, 0.1);
  const TileMap tiles(space);
  TileDistances distances(tiles);
  EXPECT_TRUE(space.at({25, 35}));
  distances.measure({25, 35}, 1e6, tiles.size());
  EXPECT_FALSE(distances.at(tiles.tile_at({35.5, 35.5})).has_value()) << "two cells are too narrow a gap";
  const OccupancyMap open = [&] {
    for (std::size_t row = 30; row < 38; ++row) rows[row][30] = '.';
    return map_from(rows, 0.05);
  }();
  const CollisionChecker open_space(open, 0.1);
  const TileMap open_tiles(open_space);
  TileDistances around(open_tiles);
  around.measure({25, 35}, 1e6, open_tiles.size());
  EXPECT_GT(around.at(open_tiles.tile_at({35.5, 35.5})).value(), 50.0) << "down to the gap and up again";
}

TEST(JumpSearch, finds_shortest_paths_on_a_map_too_large_for_a_node_a_cell) {
  Random random(34);
  const OccupancyMap map = random_map(random, 1200, 1000, 0.25);
  const CollisionChecker space(map, 0.0);
  const JumpScan scan(space);
  JumpSearch search(scan);
  const CellCosts even(map.cells.size(), 1.0F);
  GridSearch astar(space, even);
  for (int trial = 0; trial < 6; ++trial) {
    const Cell start = clear_cell(random, space).value();
    const Cell goal = clear_cell(random, space).value();
    const std::optional<GridPath> expected = astar.find(start, goal);
    const std::optional<JumpPath> found = search.find(start, goal);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    EXPECT_NEAR(found->steps.length_cells(), expected->cost, 1e-6 * expected->cost);
  }
}

}  // namespace
}  // namespace lodestar
