#pragma once

#include <Eigen/Core>

namespace lodestar {

/// Clearance to keep on all sides: `here_m`, plus `per_m` for each metre ahead.
struct SafetyMargin {
  double here_m = 0.0;
  double per_m = 0.0;  ///< at least 0
};

/// The safety margin for a pose covariance of (x_m, y_m, yaw_rad): 2.3 times the position's standard
/// deviation beyond the usual 5 mm (the root of the difference of the variances), plus ForwardClearance's
/// tolerance, in full from 10 mm on. It grows ahead by 2.3 times the heading's standard deviation.
SafetyMargin margin_for_uncertainty(const Eigen::Matrix3d& covariance);

/// The margin while backtracking: 2 standard deviations, as much of the error is the same as on the way out,
/// and the same tolerance.
SafetyMargin margin_on_the_way_back(const Eigen::Matrix3d& covariance);

}  // namespace lodestar
