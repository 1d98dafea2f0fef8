#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "localization/pose/pose_fix.hpp"

// The step from a first guess of the camera's pose to the one that all dots and the prior make most likely.
namespace lodestar {

/// A dot whose place on the ceiling is known.
struct SurveyedDot {
  Vec3 point_in_map = Vec3::Zero();
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.03;        ///< standard deviation of each coordinate of the centre
  double shared_sigma_px = 0.0;  ///< the part of it that is the same in all frames: the dot is off its place
};

struct MapEstimate {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();         ///< as in PoseFix
  Eigen::Matrix<double, 6, 6> shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< as in PoseFix
  double chi2 = 0.0;  ///< sum of the dots' squared residuals in sigmas, Huber's loss where they are far off
  double freedom = 0.0;  ///< what it should be: their count less that of what they determined
  double cost = 0.0;     ///< minus twice the logarithm of the posterior density, up to a constant
};

/// Where a dot at this point of the map is seen from a pose, and the derivative by (position, rotation about
/// the map's axes): the pose moves to (translation + d.head(3), Exp(d.tail(3)) * rotation). Nothing behind
/// the camera. A dot is a horizontal disc. To a tilted camera it is an ellipse whose middle is not the image
/// of the disc's own: it lies off by some f (radius / distance)^2 sin(2 tilt) / 2, 0.005 px at 20 degrees
/// and 1.5 m.
struct Projection {
  Vec2 pixel;
  Eigen::Matrix<double, 2, 6> jacobian;
};
std::optional<Projection> project_dot(const Eigen::Isometry3d& map_from_camera, const Vec3& point_in_map,
                                      const CameraModel& camera);

/// The cost of a pose: Huber's loss of the dots, in squared sigmas, and the prior's. Infinite when a dot
/// comes to lie behind the camera. An exact tilt costs nothing here.
double cost_of(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots,
               const CameraModel& camera, const PoseFixOptions& options);

/// The prior's part of it.
double prior_cost(const Eigen::Isometry3d& map_from_camera, const PosePrior& prior);

/// Levenberg-Marquardt. Nothing when a dot comes to lie behind the camera or the dots do not determine the
/// pose.
std::optional<MapEstimate> maximize_posterior(const Eigen::Isometry3d& guess,
                                              std::span<const SurveyedDot> dots, const CameraModel& camera,
                                              const PoseFixOptions& options);

/// The likelier of two estimates from the same dots. Its covariance is about its own pose, but of both: where
/// two poses explain the dots almost alike, it says so.
MapEstimate likelier(const MapEstimate& a, const MapEstimate& b);

}  // namespace lodestar
