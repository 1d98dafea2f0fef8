#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "maps/distance_field.hpp"
#include "maps/geometry.hpp"
#include "maps/input_error.hpp"
#include "maps/motion.hpp"
#include "maps/octomap_file.hpp"
#include "maps/random.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

OccupancyMap random_map(Random& random, int columns, int rows, double share) {
  OccupancyMap map;
  map.columns = columns;
  map.rows = rows;
  map.resolution_m = 0.1;
  for (int i = 0; i < columns * rows; ++i)
    map.cells.push_back(random.uniform() < share ? std::int8_t{100} : std::int8_t{0});
  return map;
}

int squared_by_brute_force(const OccupancyMap& map, Cell cell) {
  int best = std::numeric_limits<int>::max();
  for (int row = -1; row <= map.rows; ++row) {
    for (int column = -1; column <= map.columns; ++column) {
      const Cell other{column, row};
      if (map.contains(other) && is_drivable(map.at(other))) continue;
      const int dx = column - cell.column;
      const int dy = row - cell.row;
      best = std::min(best, dx * dx + dy * dy);
    }
  }
  return best;
}

TEST(DistanceField, agrees_with_trying_every_cell) {
  Random random(1);
  for (const double share : {0.0, 0.005, 0.05, 0.5, 1.0}) {
    for (int trial = 0; trial < 10; ++trial) {
      const OccupancyMap map = random_map(random, 1 + static_cast<int>(random.below(40)),
                                          1 + static_cast<int>(random.below(30)), share);
      const DistanceField field(map);
      for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
          ASSERT_EQ(field.squared_cells({column, row}), squared_by_brute_force(map, {column, row}))
              << column << ", " << row;
        }
      }
    }
  }
}

TEST(DistanceField, takes_unknown_for_an_obstacle_and_answers_in_metres) {
  Random random(2);
  OccupancyMap map = random_map(random, 41, 41, 0.0);
  map.cells[map.index({20, 20})] = OccupancyMap::unknown;
  const DistanceField field(map);
  EXPECT_DOUBLE_EQ(field.distance_m({23, 24}), 0.5);
  EXPECT_EQ(field.distance_m({20, 20}), 0.0);
}

TEST(OccupancyMap, finds_cells_on_a_turned_grid) {
  Random random(3);
  OccupancyMap map = random_map(random, 20, 10, 0.0);
  map.map_from_grid = {{5.0, -3.0}, 1.1};
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column)
      EXPECT_EQ(map.cell_at(map.center_of({column, row})), (Cell{column, row}));
  }
  EXPECT_FALSE(map.contains(map.cell_at({std::nan(""), 0.0})));
  EXPECT_FALSE(map.contains(map.cell_at({1e300, 0.0})));
}

TEST(Geometry, wraps_into_the_half_open_turn) {
  EXPECT_EQ(wrap_angle(-std::numbers::pi), std::numbers::pi);
  EXPECT_EQ(wrap_angle(std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(wrap_angle(7.0), 7.0 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
}

TEST(Geometry, poses_compose_like_transforms) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const auto any = [&] {
      return Pose2{{random.uniform(-9, 9), random.uniform(-9, 9)}, random.uniform(-3.1, 3.1)};
    };
    const Pose2 a = any();
    const Pose2 b = any();
    const Vec2 p(random.uniform(-9, 9), random.uniform(-9, 9));
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
    EXPECT_LT((inverse(a) * (a * p) - p).norm(), 1e-12);
    EXPECT_LT((flattened(lifted(a, 2.0) * lifted(b)).position_m - (a * b).position_m).norm(), 1e-12);
  }
}

TEST(Geometry, angles_and_rotation_are_inverse) {
  const RollPitchYaw angles{0.1, -0.4, 2.5};
  const RollPitchYaw back = angles_of(rotation_from(angles));
  EXPECT_NEAR(back.roll_rad, 0.1, 1e-12);
  EXPECT_NEAR(back.pitch_rad, -0.4, 1e-12);
  EXPECT_NEAR(back.yaw_rad, 2.5, 1e-12);
}

TEST(Path, knows_its_length_and_the_distance_to_it) {
  const Path path{{Vec2(0, 0), Vec2(3, 0), Vec2(3, 4)}};
  EXPECT_DOUBLE_EQ(length_m(path), 7.0);
  EXPECT_DOUBLE_EQ(distance_to_path_m(path, {1, 2}), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_path_m(path, {3, 6}), 2.0);
  EXPECT_TRUE(std::isinf(distance_to_path_m(Path{}, {0, 0})));
}

TEST(Octomap, public_tree_is_sliced) {
  const std::filesystem::path file =
      std::filesystem::path(LODESTAR_SOURCE_DIR) / "../shared/data/octomap/geb079.bt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no maps of other projects";
  const Octomap octomap(file);
  const OctomapInfo info = octomap.info();
  EXPECT_GT(info.leaves_occupied, 1000U);
  const double middle = 0.5 * (info.low_m.z() + info.high_m.z());
  const OccupancyMap map = octomap.slice(middle, middle + 0.5);
  EXPECT_EQ(map.columns, std::lround((info.high_m.x() - info.low_m.x()) / info.resolution_m));
  EXPECT_GT(std::ranges::count(map.cells, OccupancyMap::occupied), 100);
  EXPECT_GT(std::ranges::count(map.cells, OccupancyMap::free), 100);
  EXPECT_THROW((void)octomap.slice(1.0, 1.0), InputError);
  EXPECT_THROW((void)octomap.slice(1000.0, 1001.0), InputError);
}

TEST(Octomap, refuses_what_is_no_tree) {
  const TemporaryFolder folder;
  for (const std::string& text :
       {std::string(), std::string("hello\n"), std::string("# Octomap OcTree binary file\n"),
        std::string("# Octomap OcTree binary file\nid OcTree\nsize 99\nres 0.05\ndata\nab"),
        std::string("# Octomap OcTree file\nid Nonsense\nsize 1\nres 0.05\ndata\n")}) {
    EXPECT_THROW(Octomap(folder.write("tree.bt", text)), InputError) << text;
  }
  EXPECT_THROW(Octomap(folder / "missing.bt"), InputError);
}

}  // namespace
}  // namespace lodestar
