#include "app/ros2/ros2_commands.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lodestar {
namespace {

ReceivedPose upright(double yaw_rad) {
  return {.frame = "map",
          .position_m = {1.0, 2.0, 0.1},
          .quaternion = {0.0, 0.0, std::sin(0.5 * yaw_rad), std::cos(0.5 * yaw_rad)}};
}

std::string complaint(const ReceivedPose& pose) {
  const auto found = planar_pose(pose);
  return std::holds_alternative<std::string>(found) ? std::get<std::string>(found) : "";
}

TEST(PlanarPose, is_read_for_every_heading) {
  for (double yaw_rad = -3.1; yaw_rad < 3.2; yaw_rad += 0.1) {
    const auto found = planar_pose(upright(yaw_rad));
    ASSERT_TRUE(std::holds_alternative<Pose2>(found)) << yaw_rad;
    EXPECT_NEAR(std::get<Pose2>(found).yaw_rad, wrap_angle(yaw_rad), 1e-12);
    EXPECT_EQ(std::get<Pose2>(found).position_m, Vec2(1.0, 2.0));
  }
}

TEST(PlanarPose, takes_the_slash_of_ros_1) {
  ReceivedPose pose = upright(0.3);
  pose.frame = "/map";
  EXPECT_EQ(complaint(pose), "");
}

TEST(PlanarPose, is_refused_with_a_reason) {
  ReceivedPose pose = upright(0.3);
  pose.frame = "base_link";
  EXPECT_EQ(complaint(pose), "found frame 'base_link', wanted map");
  pose = upright(0.3);
  pose.position_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(pose), "found a number that is not finite");
  pose = upright(0.3);
  pose.quaternion[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint(pose), "found a number that is not finite");
  pose = upright(0.3);
  pose.position_m.y() = -1e5;
  EXPECT_EQ(complaint(pose), "found a place beyond 10 km");
  pose = upright(0.3);
  pose.quaternion = {0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(complaint(pose), "found a quaternion of length 0, wanted 1");
  pose.quaternion = {std::sin(0.1), 0.0, 0.0, std::cos(0.1)};
  EXPECT_EQ(complaint(pose), "found a pose that does not stand upright");
}

TEST(PlacingSigma, is_that_of_the_covariance_within_bounds) {
  std::array<double, 36> covariance{};
  EXPECT_EQ(placing_sigma(covariance).position_m, PlacingSigma{}.position_m);
  EXPECT_EQ(placing_sigma(covariance).heading_rad, PlacingSigma{}.heading_rad);
  covariance[0] = 0.04;
  covariance[7] = 0.09;
  covariance[35] = 0.01;
  EXPECT_NEAR(placing_sigma(covariance).position_m, 0.3, 1e-12);
  EXPECT_NEAR(placing_sigma(covariance).heading_rad, 0.1, 1e-12);
  covariance[0] = 1e9;
  covariance[35] = 1e-20;
  EXPECT_EQ(placing_sigma(covariance).position_m, 1.0);
  EXPECT_EQ(placing_sigma(covariance).heading_rad, radians(0.5));
  covariance.fill(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(placing_sigma(covariance).position_m, PlacingSigma{}.position_m);
}

}  // namespace
}  // namespace lodestar
