#include "app/ros2/ros2_shapes.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lodestar {
namespace {

OccupancyMap turned_map(double yaw_rad) {
  OccupancyMap map{
      .columns = 3, .rows = 2, .resolution_m = 0.5, .map_from_grid = {{1.0, 2.0}, yaw_rad}, .cells = {}};
  map.cells = {0, 100, -1, 50, 0, 100};
  return map;
}

TEST(AxisAligned, leaves_a_map_along_the_axes_as_it_is) {
  const OccupancyMap map = turned_map(0.0);
  const OccupancyMap aligned = axis_aligned(map);
  EXPECT_EQ(aligned.cells, map.cells);
  EXPECT_EQ(aligned.map_from_grid.position_m, map.map_from_grid.position_m);
}

TEST(AxisAligned, turns_by_a_quarter_cell_by_cell) {
  const OccupancyMap map = turned_map(radians(90.0));
  const OccupancyMap aligned = axis_aligned(map);
  EXPECT_EQ(aligned.columns, 2);
  EXPECT_EQ(aligned.rows, 3);
  EXPECT_EQ(aligned.map_from_grid.yaw_rad, 0.0);
  EXPECT_NEAR(aligned.map_from_grid.position_m.x(), 0.0, 1e-9);  // 1.0 less two rows of 0.5 m
  EXPECT_NEAR(aligned.map_from_grid.position_m.y(), 2.0, 1e-9);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      EXPECT_EQ(aligned.at(aligned.cell_at(map.center_of({column, row}))), map.at({column, row}));
}

TEST(AxisAligned, knows_nothing_beyond_a_map_that_lies_askew) {
  const OccupancyMap map = turned_map(radians(30.0));
  const OccupancyMap aligned = axis_aligned(map);
  for (int row = 0; row < aligned.rows; ++row) {
    for (int column = 0; column < aligned.columns; ++column) {
      const Cell there = map.cell_at(aligned.center_of({column, row}));
      EXPECT_EQ(aligned.at({column, row}), map.contains(there) ? map.at(there) : OccupancyMap::unknown);
    }
  }
  EXPECT_GT(std::ranges::count(aligned.cells, OccupancyMap::unknown), 1);
}

Scan turn_of(std::vector<Beam> beams) {
  Scan scan{.beams = std::move(beams), .min_range_m = 0.1, .max_range_m = 12.0};
  for (std::size_t i = 0; i < scan.beams.size(); ++i)
    scan.beams[i].stamp = Stamp(std::chrono::milliseconds(1000 + 10 * static_cast<int>(i)));
  return scan;
}

TEST(EvenScanTest, keeps_the_kinds_of_echo_apart) {
  const EvenScan even =
      lodestar::even(turn_of({{.angle_rad = -0.2, .range_m = 2.0, .intensity = 0.5F, .echo = Echo::hit},
                              {.angle_rad = 0.0, .echo = Echo::nothing},
                              {.angle_rad = 0.2, .echo = Echo::too_near},
                              {.angle_rad = 0.4, .echo = Echo::invalid}}));
  ASSERT_EQ(even.ranges_m.size(), 4U);
  EXPECT_FLOAT_EQ(even.ranges_m[0], 2.0F);
  EXPECT_FLOAT_EQ(even.intensities[0], 0.5F);
  EXPECT_EQ(even.ranges_m[1], std::numeric_limits<float>::infinity());
  EXPECT_EQ(even.ranges_m[2], -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(even.ranges_m[3]));
  EXPECT_NEAR(even.first_rad, -0.2, 1e-12);
  EXPECT_NEAR(even.step_rad, 0.2, 1e-12);
  EXPECT_NEAR(even.step_s, 0.01, 1e-12);
  EXPECT_NEAR(even.turn_s, 0.03, 1e-12);
  EXPECT_EQ(even.stamp, Stamp(std::chrono::seconds(1)));
}

TEST(EvenScanTest, of_a_scanner_that_turns_the_other_way_says_no_time_between_beams) {
  const EvenScan even = lodestar::even(turn_of({{.angle_rad = 0.2, .range_m = 3.0, .echo = Echo::hit},
                                                {.angle_rad = 0.0, .range_m = 2.0, .echo = Echo::hit},
                                                {.angle_rad = -0.2, .range_m = 1.0, .echo = Echo::hit}}));
  EXPECT_EQ(even.ranges_m, (std::vector<float>{1.0F, 2.0F, 3.0F}));
  EXPECT_EQ(even.step_s, 0.0);
  EXPECT_NEAR(even.turn_s, 0.02, 1e-12);
}

TEST(EvenScanTest, gives_uneven_beams_to_the_nearest_angle_and_lets_the_nearer_win) {
  const EvenScan even = lodestar::even(turn_of({{.angle_rad = 0.0, .range_m = 1.0, .echo = Echo::hit},
                                                {.angle_rad = 0.01, .range_m = 0.5, .echo = Echo::hit},
                                                {.angle_rad = 0.02, .range_m = 0.8, .echo = Echo::hit},
                                                {.angle_rad = 0.3, .range_m = 4.0, .echo = Echo::hit}}));
  ASSERT_EQ(even.ranges_m.size(), 4U);
  EXPECT_FLOAT_EQ(even.ranges_m[0], 0.5F);
  EXPECT_TRUE(std::isnan(even.ranges_m[1]));
  EXPECT_TRUE(std::isnan(even.ranges_m[2]));
  EXPECT_FLOAT_EQ(even.ranges_m[3], 4.0F);
}

TEST(EvenScanTest, of_nothing_and_of_one_beam) {
  EXPECT_TRUE(lodestar::even({}).ranges_m.empty());
  const EvenScan one = lodestar::even(turn_of({{.angle_rad = 1.0, .range_m = 2.0, .echo = Echo::hit}}));
  EXPECT_EQ(one.ranges_m, (std::vector<float>{2.0F}));
  EXPECT_EQ(one.step_rad, 0.0);
}

TEST(Diagnostics, say_what_is_wrong_and_where) {
  using Level = DiagnosticLine::Level;
  Ros2Report report{.now = Stamp(std::chrono::seconds(10)),
                    .stop = StopReason::no_pose,
                    .base = BaseState::fault,
                    .fault = BaseFault::emergency_stop};
  std::vector<DiagnosticLine> lines = diagnostics_of(report);
  EXPECT_EQ(lines[0].level, Level::error);
  EXPECT_EQ(lines[1].level, Level::error);
  EXPECT_EQ(lines[2].level, Level::warn);
  EXPECT_EQ(lines[2].message, "must not move: " + std::string(to_string(StopReason::no_pose)));

  report.stop.reset();
  report.base = BaseState::ready;
  report.fault.reset();
  report.estimate = PoseEstimate{.stamp = report.now, .last_fix = report.now, .last_agreed = report.now};
  report.estimate->covariance = Eigen::Vector3d(4e-6, 9e-6, 1e-6).asDiagonal();
  lines = diagnostics_of(report);
  EXPECT_EQ(lines[0].level, Level::ok);
  EXPECT_EQ(lines[0].message, "pose within 3 mm, seen 0.0 s ago");
  EXPECT_EQ(lines[1].level, Level::ok);
  EXPECT_EQ(lines[2].message, "no goal");
  report.now += std::chrono::seconds(5);
  EXPECT_EQ(diagnostics_of(report)[0].level, Level::warn);
}

}  // namespace
}  // namespace lodestar
