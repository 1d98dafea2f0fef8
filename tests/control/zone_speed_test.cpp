#include "control/zone_speed.hpp"

#include <gtest/gtest.h>

#include "control/rotate_then_drive.hpp"

#include "tests/control/plant.hpp"

namespace lodestar {
namespace {

constexpr double radius_m = 0.25;

//   0 ---------------- [ 3 .. 4 ] ------------- 6
const SpeedZone across{
    .name = "across", .corners_m = {{3.0, -1.0}, {4.0, -1.0}, {4.0, 1.0}, {3.0, 1.0}}, .max_mps = 0.15};
const SpeedZone beside{.name = "beside", .corners_m = {{1.0, 0.4}, {5.0, 0.4}, {3.0, 2.0}}, .max_mps = 0.4};

PoseEstimate standing_at(const Vec2& position_m, double sigma_m) {
  PoseEstimate estimate;
  estimate.map_from_base.position_m = position_m;
  estimate.covariance = Eigen::Matrix3d::Zero();
  estimate.covariance.diagonal() << square(sigma_m), square(sigma_m), 1e-6;
  return estimate;
}

TEST(ZoneSpeed, is_the_zones_where_any_part_of_the_robot_may_be_inside) {
  const ZoneSpeed speed({across}, RobotShape(radius_m), {});
  EXPECT_DOUBLE_EQ(*speed.limit_mps(standing_at({3.5, 0.0}, 0.0)), 0.97 * 0.15);
  EXPECT_DOUBLE_EQ(*speed.limit_mps(standing_at({2.76, 0.0}, 0.0)), 0.97 * 0.15);
  EXPECT_GT(*speed.limit_mps(standing_at({2.60, 0.0}, 0.0)), 0.2);
  EXPECT_DOUBLE_EQ(*speed.limit_mps(standing_at({2.60, 0.0}, 0.07)), 0.97 * 0.15);  // 2.3 sigma: 0.16 m
  EXPECT_FALSE(speed.limit_mps(standing_at({1.0, 0.0}, 0.0)));
  EXPECT_FALSE(ZoneSpeed({}, RobotShape(radius_m), {}).limit_mps(standing_at({3.5, 0.0}, 0.0)));
}

TEST(ZoneSpeed, is_the_least_of_zones_that_overlap_and_none_above_the_robots_own) {
  const ZoneSpeed both({beside, across}, RobotShape(radius_m), {});
  EXPECT_DOUBLE_EQ(*both.limit_mps(standing_at({3.5, 0.3}, 0.0)), 0.97 * 0.15);
  EXPECT_DOUBLE_EQ(*both.limit_mps(standing_at({2.0, 0.3}, 0.0)), 0.97 * 0.4);
  const ZoneSpeed slow({beside}, RobotShape(radius_m), {.max_forward_mps = 0.3});
  EXPECT_FALSE(slow.limit_mps(standing_at({2.0, 0.3}, 0.0)));
}

TEST(ZoneSpeed, is_never_so_low_that_the_motors_stand_still) {
  const SpeedZone creep{.name = "creep", .corners_m = across.corners_m, .max_mps = 0.02};
  const ZoneSpeed speed({creep}, RobotShape(radius_m), {});
  EXPECT_DOUBLE_EQ(*speed.limit_mps(standing_at({3.5, 0.0}, 0.0)), DriveOptions{}.min_forward_mps);
}

TEST(ZoneSpeed, is_reached_by_the_border_as_late_as_braking_allows) {
  const ZoneSpeed zone({across}, RobotShape(radius_m), {});
  RotateThenDrive drive({{Vec2::Zero(), Vec2(6.0, 0.0)}}, std::nullopt, {});
  Plant plant;
  double slows_at_m = 0.0;
  double fastest_inside_mps = 0.0;
  double fastest_after_mps = 0.0;
  for (int step = 0; step < 3000 && !drive.arrived(); ++step) {
    PoseEstimate estimate = plant.sensed();
    estimate.covariance = standing_at({}, 0.002).covariance;
    plant.run(drive.update(estimate, from_seconds(period_s), lowered({}, zone.limit_mps(estimate))));
    const double speed_mps = 0.5 * (plant.wheels.left_mps + plant.wheels.right_mps);
    const double x_m = plant.truth.position_m.x();
    if (speed_mps > 0.59) slows_at_m = x_m < 3.0 ? x_m : slows_at_m;
    if (x_m > 3.0 - radius_m && x_m < 4.0 + radius_m)
      fastest_inside_mps = std::max(fastest_inside_mps, speed_mps);
    if (x_m > 4.0 + radius_m) fastest_after_mps = std::max(fastest_after_mps, speed_mps);
  }
  EXPECT_TRUE(drive.arrived());
  EXPECT_LE(fastest_inside_mps, 0.15);
  EXPECT_GT(fastest_inside_mps, 0.14);
  EXPECT_GT(slows_at_m, 2.1);  // 0.43 m to brake from 0.6 to 0.15 m/s, 0.1 m for the lag
  EXPECT_GT(fastest_after_mps, 0.55);
}

TEST(ZoneSpeed, lowers_both_senses_of_driving_and_nothing_else) {
  const SpeedLimit limit = lowered({.forward_mps = 0.1, .turn_radps = 0.5}, 0.2);
  EXPECT_EQ(limit.forward_mps, 0.1);
  EXPECT_EQ(limit.backward_mps, 0.2);
  EXPECT_EQ(limit.turn_radps, 0.5);
  EXPECT_EQ(lowered({.forward_mps = 0.4}, 0.2).forward_mps, 0.2);
  EXPECT_EQ(lowered({.forward_mps = 0.4}, std::nullopt).forward_mps, 0.4);
}

}  // namespace
}  // namespace lodestar
