#pragma once

#include <Eigen/Core>

namespace lodestar {

/// The room to be kept on all sides: so much here, and more the farther the robot goes on.
struct SafetyMargin {
  double here_m = 0.0;
  double per_m = 0.0;  ///< at least 0
};

/// What an unsure robot keeps, by the covariance of its (x_m, y_m, yaw_rad): 2.3 times the deviation of its
/// position, beyond the usual half centimetre for which paths have room; and no longer the tolerance that a
/// disc is otherwise taken to be smaller by. On its way the error of its heading makes it less sure.
SafetyMargin margin_for_uncertainty(const Eigen::Matrix3d& covariance);

/// As it goes back by which it has come, much of its error is what it was then: two deviations.
SafetyMargin margin_on_the_way_back(const Eigen::Matrix3d& covariance);

}  // namespace lodestar
