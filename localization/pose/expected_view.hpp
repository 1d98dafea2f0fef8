#pragma once

#include <Eigen/Core>
#include <optional>

#include "localization/pose/pose_fix.hpp"
#include "maps/geometry.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Where a camera is thought to be before its frame is looked at. The covariance is as in PoseFix.
struct ExpectedView {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// By where the robot is thought to be, the camera's mount, and what the prior says of its tilt and height.
/// Nothing when the tilt is free.
std::optional<ExpectedView> expected_view(const PoseEstimate& robot,
                                          const Eigen::Isometry3d& base_from_camera, const PosePrior& prior);

/// How fast a camera may have moved between two frames.
struct CameraMotionLimits {
  double speed_mps = 1.5;
  double turn_radps = 2.0;  ///< about any axis
};

/// By the last frame's pose and the time since. The limits are taken for two standard deviations.
ExpectedView expected_view(const PoseFix& last, Duration since, const CameraMotionLimits& limits = {});

}  // namespace lodestar
