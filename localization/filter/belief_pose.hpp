#pragma once

#include "localization/filter/belief.hpp"

// The robot's pose as a belief has it, for the corrections of belief.cpp and belief_keyframe.cpp.
namespace lodestar {

/// The robot's pose (x_m, y_m, yaw_rad): that of the readings, and their lag times the velocity.
Eigen::Vector3d pose_of(const Belief& belief);

/// Its derivative by the state. That of the velocity's direction is left out: the lag's way is 1 cm at most.
Belief::ByState pose_by_state(const Belief& belief);

/// Covariance between the robot's pose and the one that the readings give: of their rounding, and of their
/// jitter in time. It is independent at each time and must not accumulate along the way, as it would in
/// moved().
Eigen::Matrix3d reading_covariance(const Belief& belief, const PoseFilterOptions& options);

/// Half of what rounding makes two triangles differ by goes to each. Where a correction is sharp along one
/// direction, the difference would grow fivefold with each, and within seconds the covariance were none.
template <typename Square>
typename Square::PlainObject symmetric(const Square& covariance) {
  const typename Square::PlainObject whole = covariance;
  return 0.5 * (whole + whole.transpose());
}

/// Joseph form (Bucy and Joseph 1968): keeps the covariance positive, and is correct for any gain. Of
/// (1 - K H) P (1 - K H)^T + K R K^T only products with three columns are formed.
template <typename Square, typename Gain, typename ByState>
Square after_correction(const Square& before, const Gain& gain, const ByState& by_state,
                        const Eigen::Matrix3d& noise) {
  Square after = before;
  after.noalias() -= gain * (by_state * before).eval();
  const Gain seen = after * by_state.transpose() - gain * noise;
  after.noalias() -= seen * gain.transpose();
  return symmetric(after);
}

}  // namespace lodestar
