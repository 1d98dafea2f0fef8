#pragma once

#include <Eigen/Core>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Motion of the base from one frame of the ceiling to another, by visual odometry.
struct VisualOdometryIncrement {
  Stamp from;
  Stamp to;
  Pose2 then_from_now;
  /// Of (x_m, y_m, yaw_rad) in the base frame at `from`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Standard deviation of the lateral offset between a frame's pose and the base's, due to the body's sway.
  double sway_m = 0.0;
};

}  // namespace lodestar
