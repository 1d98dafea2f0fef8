#pragma once

#include <Eigen/Core>
#include <optional>

#include "localization/pose/pose_fix.hpp"
#include "maps/geometry.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Predicted pose of a camera before its frame is processed. The covariance is as in PoseFix.
struct ExpectedView {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// From the robot's pose, the camera's mount, and the prior's sigmas of tilt and height. Nothing when the
/// tilt is free.
std::optional<ExpectedView> expected_view(const PoseEstimate& robot,
                                          const Eigen::Isometry3d& base_from_camera, const PosePrior& prior);

/// Limits of the camera's motion between two frames.
struct CameraMotionLimits {
  double speed_mps = 1.5;
  double turn_radps = 2.0;  ///< about any axis
};

/// From the last frame's pose and the time since. The limits count as two standard deviations.
ExpectedView expected_view(const PoseFix& last, Duration since, const CameraMotionLimits& limits = {});

}  // namespace lodestar
