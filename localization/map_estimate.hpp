#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/pose_fix.hpp"

// The step from a first guess of the camera's pose to the one that all dots and the prior make most likely.
namespace lodestar {

/// A dot whose place on the ceiling is known.
struct SurveyedDot {
  Vec3 point_in_map = Vec3::Zero();
  Vec2 center_px = Vec2::Zero();
};

struct MapEstimate {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< as in PoseFix
  double cost = 0.0;  ///< minus twice the logarithm of the posterior density, up to a constant
};

/// Where a point of the map is seen from a pose, and the derivative by (position, rotation about the map's
/// axes): the pose moves to (translation + d.head(3), Exp(d.tail(3)) * rotation). Nothing behind the camera.
struct Projection {
  Vec2 pixel;
  Eigen::Matrix<double, 2, 6> jacobian;
};
std::optional<Projection> project_dot(const Eigen::Isometry3d& map_from_camera, const Vec3& point_in_map,
                                      const CameraModel& camera);

/// Levenberg-Marquardt with Huber's loss on the dots, and the prior. Nothing when a dot comes to lie behind
/// the camera or the dots do not determine the pose.
std::optional<MapEstimate> maximize_posterior(const Eigen::Isometry3d& guess,
                                              const std::vector<SurveyedDot>& dots, const CameraModel& camera,
                                              const PoseFixOptions& options);

}  // namespace lodestar
