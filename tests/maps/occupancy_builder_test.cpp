#include "maps/occupancy_builder.hpp"

#include <gtest/gtest.h>

#include "maps/grid_walk.hpp"

#include "tests/maps/cast_scan.hpp"

namespace lodestar {
namespace {

using testing::cast_scan;
using testing::Disc;
using testing::poses_of;

TEST(GridWalk, visits_the_cells_of_a_way_in_order_and_says_where_it_enters_them) {
  std::vector<Cell> cells;
  double covered = 0.0;
  walk_grid({0.5, 0.5}, {-2.5, 1.9}, [&](Cell cell, double enters, double leaves) {
    EXPECT_NEAR(enters, covered, 1e-12);
    covered = leaves;
    cells.push_back(cell);
    return true;
  });
  EXPECT_DOUBLE_EQ(covered, 1.0);
  const std::vector<Cell> expected{{0, 0}, {-1, 0}, {-1, 1}, {-2, 1}, {-3, 1}};
  EXPECT_EQ(cells, expected);
}

TEST(GridWalk, ends_where_it_should_from_anywhere_to_anywhere) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    // Whole numbers among them: ways along borders and through corners.
    const auto anywhere = [&] {
      const double value = random.uniform(-20.0, 20.0);
      return random.uniform() < 0.5 ? std::round(value) : value;
    };
    const Vec2 from(anywhere(), anywhere());
    const Vec2 to(anywhere(), anywhere());
    Cell last{999, 999};
    walk_grid(from, to, [&](Cell cell, double, double) {
      last = cell;
      return true;
    });
    EXPECT_EQ(last, cell_at(to)) << from.transpose() << " to " << to.transpose();
  }
}

/// A single beam along x from (0.52, 0.52) to 2 m ahead, three times.
TEST(OccupancyBuilder, frees_the_way_of_a_beam_and_occupies_its_end) {
  OccupancyBuilder builder;
  const Scan scan{.beams = {{.angle_rad = 0.0, .range_m = 2.0, .echo = Echo::hit}}, .max_range_m = 10.0};
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(builder.add(scan, poses_of(scan, {{0.52, 0.52}, 0.0})));
  const OccupancyMap map = builder.map();
  EXPECT_EQ(map.rows, 1);
  EXPECT_EQ(map.columns, 41);  // cells 10 to 50
  EXPECT_EQ(map.at(map.cell_at({0.52, 0.52})), OccupancyMap::free);
  EXPECT_EQ(map.at(map.cell_at({2.48, 0.52})), OccupancyMap::free);
  EXPECT_EQ(map.at(map.cell_at({2.53, 0.52})), OccupancyMap::occupied);
  EXPECT_NEAR((map.center_of({0, 0}) - Vec2(0.525, 0.525)).norm(), 0.0, 1e-12);
}

TEST(OccupancyBuilder, takes_only_hits_for_things_and_only_what_is_known_for_free) {
  for (const Echo echo : {Echo::nothing, Echo::too_near, Echo::invalid}) {
    OccupancyBuilder builder;
    const Scan scan{.beams = {{.angle_rad = 0.0, .range_m = 2.0, .echo = echo}}, .max_range_m = 10.0};
    for (int i = 0; i < 9; ++i) ASSERT_TRUE(builder.add(scan, poses_of(scan, {})));
    const OccupancyMap map = builder.map();
    EXPECT_EQ(std::ranges::count(map.cells, OccupancyMap::occupied), 0);
    const int free_to_3_m = echo == Echo::nothing ? 61 : 0;
    EXPECT_EQ(std::ranges::count(map.cells, OccupancyMap::free), free_to_3_m) << static_cast<int>(echo);
  }
}

TEST(OccupancyBuilder, forgets_people_who_walk_on) {
  const OccupancyMap room = testing::walled_room(6.0, 4.0);
  OccupancyBuilder builder;
  Random random(8);
  const Pose2 pose{{1.0, 2.0}, 0.2};
  for (int i = 0; i < 100; ++i) {
    // One stands at (4, 2) for a quarter of the time, and walks off.
    const Disc walker{i < 25 ? Vec2(4.0, 2.0) : Vec2(4.0, 2.0 + 0.08 * (i - 25)), 0.2};
    const Scan scan = cast_scan(room, {walker}, Stamp{}, [&](Stamp) { return pose; }, random);
    ASSERT_TRUE(builder.add(scan, poses_of(scan, pose)));
  }
  const OccupancyMap map = builder.map();
  for (double x_m = 0.6; x_m < 5.5; x_m += 0.05)
    for (double y_m = 0.6; y_m < 3.5; y_m += 0.05)
      EXPECT_NE(map.at(map.cell_at({x_m, y_m})), OccupancyMap::occupied) << x_m << ", " << y_m;
  EXPECT_EQ(map.at(map.cell_at({5.975, 2.0})), OccupancyMap::occupied) << "the wall behind";
}

TEST(OccupancyBuilder, grows_in_each_direction_and_keeps_what_it_has) {
  OccupancyBuilder builder;
  const Scan scan{.beams = {{.angle_rad = 0.0, .range_m = 1.0, .echo = Echo::hit}}, .max_range_m = 10.0};
  for (const Vec2& at : {Vec2(0.02, 0.02), Vec2(-30.02, 0.02), Vec2(0.02, -30.02), Vec2(30.02, 30.02)})
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(builder.add(scan, poses_of(scan, {at, 0.0})));
  const OccupancyMap map = builder.map();
  for (const Vec2& end : {Vec2(1.03, 0.02), Vec2(-28.97, 0.02), Vec2(1.03, -30.02), Vec2(31.03, 30.02)})
    EXPECT_EQ(map.at(map.cell_at(end)), OccupancyMap::occupied) << end.transpose();
  EXPECT_EQ(std::ranges::count(map.cells, OccupancyMap::occupied), 4);
}

TEST(OccupancyBuilder, refuses_a_scan_from_too_far_away) {
  OccupancyBuilder builder;
  const Scan scan{.beams = {{.angle_rad = 0.0, .range_m = 1.0, .echo = Echo::hit}}, .max_range_m = 10.0};
  ASSERT_TRUE(builder.add(scan, poses_of(scan, {})));
  EXPECT_FALSE(builder.add(scan, poses_of(scan, {{900.0, 900.0}, 0.0})));
  EXPECT_FALSE(builder.add(scan, poses_of(scan, {{1e300, 0.0}, 0.0})));
  EXPECT_FALSE(builder.add(scan, poses_of(scan, {{std::nan(""), 0.0}, 0.0})));
  EXPECT_EQ(builder.scans(), 1U);
}

}  // namespace
}  // namespace lodestar
