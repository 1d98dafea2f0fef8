#pragma once

#include <Eigen/Core>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// How the base has moved from one picture of the ceiling to another, as these show it.
struct VisualOdometryIncrement {
  Stamp from;
  Stamp to;
  Pose2 then_from_now;
  /// Of (x_m, y_m, yaw_rad) in the base frame of then.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// A body that sways looks aside: by so much a picture's place is off from the base's (standard deviation).
  double sway_m = 0.0;
};

}  // namespace lodestar
