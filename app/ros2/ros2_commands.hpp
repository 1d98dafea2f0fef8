#pragma once

#include <array>
#include <string>
#include <variant>

#include "app/ros2/ros2_report.hpp"

namespace lodestar {

/// A pose as a message brings it: anybody in the network can send one.
struct ReceivedPose {
  std::string frame;
  Vec3 position_m = Vec3::Zero();
  std::array<double, 4> quaternion{};  ///< x, y, z, w
};

/// The pose in the plane, or what is wrong with it, in words: a frame other than the map's, what is not
/// finite, a place beyond 10 km, a quaternion that is no rotation, or one that does not stand upright (5
/// degrees).
std::variant<Pose2, std::string> planar_pose(const ReceivedPose& received);

/// Of an initial pose, by its covariance (x, y, z, roll, pitch, yaw, row by row): at least 1 cm and 0.5
/// degrees, at most 1 m and 30 degrees; as with a click on the map where it says nothing.
PlacingSigma placing_sigma(const std::array<double, 36>& covariance);

}  // namespace lodestar
