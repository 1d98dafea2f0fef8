#include "maps/footprint.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "maps/input_error.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;

/// 60 cm long, 20 cm wide.
Footprint cart() {
  return Footprint({{-0.3, -0.1}, {0.3, -0.1}, {0.3, 0.1}, {-0.3, 0.1}});
}

/// True if any point of a fine lattice inside the outline is over a cell that is not drivable.
bool touches_by_sampling(const OccupancyMap& map, const Pose2& pose) {
  constexpr int lattice = 30;
  for (int i = 0; i <= lattice; ++i) {
    for (int j = 0; j <= lattice; ++j) {
      const Vec2 point = pose * Vec2(-0.299 + 0.598 * i / lattice, -0.099 + 0.198 * j / lattice);
      const Cell cell = map.cell_at(point);
      if (!map.contains(cell) || !is_drivable(map.at(cell))) return true;
    }
  }
  return false;
}

TEST(Footprint, agrees_with_sampling_its_inside) {
  Random random(31);
  int clear = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const OccupancyMap map = random_map(random, 40, 30, 0.01);
    const Pose2 pose{{random.uniform(0.0, 2.0), random.uniform(0.0, 1.5)}, random.uniform(-3.0, 3.0)};
    const bool is_clear = cart().is_clear(map, pose);
    if (is_clear) {
      EXPECT_FALSE(touches_by_sampling(map, pose));
      ++clear;
    } else {
      // Not clear: shifted by up to 2 cm, the cart must touch by sampling too.
      bool near = false;
      for (const double dx : {-0.02, 0.0, 0.02}) {
        for (const double dy : {-0.02, 0.0, 0.02})
          near = near || touches_by_sampling(map, pose * Pose2{{dx, dy}, 0.0});
      }
      EXPECT_TRUE(near);
    }
  }
  EXPECT_GT(clear, 30);
}

TEST(Footprint, sweeps_no_obstacle_where_a_drive_is_said_to_be_clear) {
  Random random(32);
  int clear = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const OccupancyMap map = random_map(random, 60, 50, 0.004);
    const double heading = random.uniform(-3.0, 3.0);
    const Path path{{{random.uniform(0.4, 2.6), random.uniform(0.4, 2.1)},
                     {random.uniform(0.4, 2.6), random.uniform(0.4, 2.1)}}};
    if (!cart().is_clear_along(map, path, heading, std::nullopt)) continue;
    ++clear;
    const Vec2 leg = path.waypoints_m[1] - path.waypoints_m[0];
    const double turn = wrap_angle(std::atan2(leg.y(), leg.x()) - heading);
    for (int i = 0; i <= 10; ++i) {
      EXPECT_FALSE(touches_by_sampling(map, {path.waypoints_m[0], heading + turn * i / 10}));
      EXPECT_FALSE(touches_by_sampling(map, {path.waypoints_m[0] + leg * (i / 10.0), heading + turn}));
    }
  }
  EXPECT_GT(clear, 10);
}

TEST(Footprint, drives_through_a_gap_in_which_it_cannot_turn) {
  // A corridor 30 cm wide; the cart is 20 cm wide and 60 cm long.
  std::vector<std::string> rows(30, std::string(60, '#'));
  for (std::size_t row = 12; row < 18; ++row) rows[row] = std::string(60, '.');
  const OccupancyMap map = map_from(rows, 0.05);
  EXPECT_TRUE(cart().is_clear_along(map, {{{0.4, 0.75}, {2.6, 0.75}}}, 0.0, 0.0));
  EXPECT_FALSE(cart().is_clear_along(map, {{{0.4, 0.75}, {2.6, 0.75}}}, 0.0, quarter));
  EXPECT_FALSE(cart().is_clear_along(map, {{{0.4, 0.75}, {2.6, 0.75}}}, std::numbers::pi, std::nullopt));
  EXPECT_FALSE(cart().is_clear(map, {{1.5, 0.75}, quarter}));
}

TEST(Footprint, may_touch_but_not_overlap_and_not_leave_the_map) {
  const OccupancyMap map = map_from({"........#", ".........", "........."}, 0.1);
  EXPECT_TRUE(cart().is_clear(map, {{0.5, 0.2}, 0.0})) << "its front touches the obstacle";
  EXPECT_TRUE(cart().is_clear(map, {{0.5, 0.1}, 0.0})) << "along the edge of the map";
  EXPECT_FALSE(cart().is_clear(map, {{0.5, 0.09}, 0.0}));
  EXPECT_FALSE(cart().is_clear(map, {{0.51, 0.2}, 0.0}));
}

TEST(Footprint, must_be_simple_and_counter_clockwise) {
  EXPECT_THROW(Footprint({{0.0, 0.0}, {1.0, 0.0}}), InputError);
  EXPECT_THROW(Footprint({{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}), InputError) << "clockwise";
  EXPECT_THROW(Footprint({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}), InputError) << "crosses itself";
  EXPECT_THROW(Footprint({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}), InputError) << "a corner twice";
  EXPECT_NO_THROW(Footprint({{0.0, 0.0}, {1.0, 0.0}, {0.2, 0.2}, {0.0, 1.0}})) << "not convex";
}

TEST(Footprint, knows_the_discs_inside_and_outside) {
  EXPECT_NEAR(cart().outer_radius_m(), std::hypot(0.3, 0.1), 1e-12);
  EXPECT_NEAR(cart().inner_radius_m(), 0.1, 1e-12);
  EXPECT_EQ(Footprint({{0.1, 0.0}, {1.0, 0.0}, {0.1, 1.0}}).inner_radius_m(), 0.0) << "origin outside";
}

/// A horseshoe: two arms ahead, a gap between them.
Footprint horseshoe() {
  return Footprint({{-0.2, -0.3},
                    {0.4, -0.3},
                    {0.4, -0.2},
                    {-0.1, -0.2},
                    {-0.1, 0.2},
                    {0.4, 0.2},
                    {0.4, 0.3},
                    {-0.2, 0.3}});
}

TEST(Footprint, need_not_be_convex) {
  OccupancyMap map = map_from(std::vector<std::string>(30, std::string(40, '.')), 0.05);
  map.cells[map.index({21, 15})] = OccupancyMap::occupied;  // between the arms
  const Pose2 pose{{0.75, 0.775}, 0.0};
  EXPECT_TRUE(horseshoe().is_clear(map, pose));
  EXPECT_TRUE(horseshoe().is_clear_driving(map, pose, {0.85, 0.775}));
  EXPECT_FALSE(horseshoe().is_clear_driving(map, pose, {1.25, 0.775})) << "its rear bar hits the obstacle";
  EXPECT_FALSE(horseshoe().is_clear_turning(map, pose, quarter)) << "an arm sweeps over the obstacle";
}

/// A turn in many small steps.
bool is_clear_in_steps(const Footprint& footprint, const OccupancyMap& map, const Pose2& from,
                       double turn_rad) {
  constexpr int steps = 4000;
  for (int i = 0; i <= steps; ++i) {
    if (!footprint.is_clear(map, {from.position_m, wrap_angle(from.yaw_rad + turn_rad * i / steps)}))
      return false;
  }
  return true;
}

TEST(Footprint, turns_are_exact) {
  Random random(33);
  int clear = 0;
  int blocked = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const OccupancyMap map = random_map(random, 30, 30, 0.01);
    const Footprint footprint = trial % 2 == 0 ? cart() : horseshoe();
    const Pose2 from{{random.uniform(0.4, 1.1), random.uniform(0.4, 1.1)}, random.uniform(-3.0, 3.0)};
    const double turn_rad = random.uniform(-3.0, 3.0);
    const bool exact = footprint.is_clear_turning(map, from, wrap_angle(from.yaw_rad + turn_rad));
    (exact ? clear : blocked) += 1;
    EXPECT_EQ(exact, is_clear_in_steps(footprint, map, from, turn_rad)) << trial;
  }
  EXPECT_GT(clear, 50);
  EXPECT_GT(blocked, 50);
}

TEST(Footprint, half_turn_is_clear_only_where_both_ways_are) {
  // The cart's tail is longer than its nose, so each way sweeps other cells.
  const Footprint tailed({{-0.5, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.5, 0.1}});
  OccupancyMap map = map_from(std::vector<std::string>(30, std::string(30, '.')), 0.05);
  map.cells[map.index({15, 22})] = OccupancyMap::occupied;  // beside the cart, on its left
  const Pose2 from{{0.775, 0.775}, 0.0};
  for (const double off_deg : {-2.9, -0.05, 0.05, 2.9}) {
    const double to_rad = wrap_angle(std::numbers::pi + radians(off_deg));
    EXPECT_FALSE(tailed.is_clear_turning(map, from, to_rad))
        << off_deg << " degrees beyond half a turn: a robot that errs by as much turns the other way";
    EXPECT_FALSE(tailed.is_clear_turning(map, {from.position_m, to_rad}, 0.0)) << off_deg;
  }
  const bool turns_left = is_clear_in_steps(tailed, map, from, std::numbers::pi - radians(3.1));
  EXPECT_EQ(tailed.is_clear_turning(map, from, std::numbers::pi - radians(3.1)), turns_left)
      << "where the way is certain, the other one does not matter";
  const bool turns_right = is_clear_in_steps(tailed, map, from, -std::numbers::pi + radians(3.1));
  EXPECT_EQ(tailed.is_clear_turning(map, from, -std::numbers::pi + radians(3.1)), turns_right);
  EXPECT_NE(turns_left, turns_right) << "the obstacle is in one way only";
  map.cells[map.index({15, 22})] = OccupancyMap::free;
  EXPECT_TRUE(tailed.is_clear_turning(map, from, std::numbers::pi));
}

TEST(Footprint, sweeps_the_same_cells_wherever_it_stands) {
  const double heading = quarter / 2.0;
  OccupancyMap map = map_from(std::vector<std::string>(41, std::string(41, '.')), 0.05);
  const Cell stands{20, 20};
  const Vec2 at = map.center_of(stands);
  const auto drive = cart().cells_driving(map.resolution_m, heading, {1, 1});
  const auto turn = cart().cells_turning(map.resolution_m, heading, heading);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      map.cells[map.index({column, row})] = OccupancyMap::occupied;
      const Cell offset{column - stands.column, row - stands.row};
      EXPECT_EQ(std::ranges::find(drive, offset) == drive.end(),
                cart().is_clear_driving(map, {at, heading}, map.center_of({21, 21})));
      EXPECT_EQ(std::ranges::find(turn, offset) == turn.end(),
                cart().is_clear_turning(map, {at, heading}, 2.0 * heading));
      map.cells[map.index({column, row})] = OccupancyMap::free;
    }
  }
}

}  // namespace
}  // namespace lodestar
