#pragma once

#include <Eigen/Core>

namespace lodestar {

/// The room to be kept on all sides: so much here, and more the farther the robot goes on.
struct SpareRoom {
  double here_m = 0.0;
  double per_m = 0.0;  ///< at least 0
};

/// What an unsure robot keeps, by the covariance of its (x_m, y_m, yaw_rad): three times the deviation of its
/// position, less the usual half centimetre, for which paths have room. On its way the error of its heading
/// makes it less sure.
SpareRoom room_for_doubt(const Eigen::Matrix3d& covariance);

}  // namespace lodestar
