#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "localization/detection/inline_vector.hpp"
#include "localization/pose/marker_offset.hpp"
#include "localization/pose/pose_fix.hpp"
#include "localization/pose/surveyed_dot.hpp"

// Refines a first guess of the camera's pose to the maximum a posteriori estimate over all dots and the
// prior.
namespace lodestar {

struct MapEstimate {
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();         ///< as in PoseFix
  Eigen::Matrix<double, 6, 6> shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< as in PoseFix
  /// Derivatives by the offsets of the first of the `markers`, in sigmas.
  InlineVector<Mat65, most_offsets_of_fix> by_offsets;
  double chi2 = 0.0;     ///< sum of the dots' squared residuals in sigmas, with Huber loss
  double freedom = 0.0;  ///< its expectation: two per dot less what the dots determine
  double cost = 0.0;     ///< -2 log posterior density, up to a constant
};

/// Image of a dot at this point of the map, and its derivative by (position, rotation about the map's axes):
/// the pose moves to (translation + d.head(3), Exp(d.tail(3)) * rotation). Nothing behind the camera. A dot
/// is a horizontal disc. A tilted camera sees an ellipse whose centre is not the image of the disc's centre:
/// it is off by about f (radius / distance)^2 sin(2 tilt) / 2, 0.005 px at 20 degrees and 1.5 m.
struct Projection {
  Vec2 pixel;
  Eigen::Matrix<double, 2, 6> jacobian;
};
std::optional<Projection> project_dot(const Eigen::Isometry3d& map_from_camera, const Vec3& point_in_map,
                                      const CameraModel& camera);

/// The cost of a pose: Huber loss of the dots, in squared sigmas, and the prior's. Infinite when a dot is
/// behind the camera. An exact tilt costs nothing here.
double cost_of(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots,
               const CameraModel& camera, const PoseFixOptions& options);

/// The prior's part of it.
double prior_cost(const Eigen::Isometry3d& map_from_camera, const PosePrior& prior);

/// Levenberg-Marquardt. Nothing when a dot gets behind the camera or the dots do not determine the pose.
/// `markers` divides the dots among markers whose places are not known exactly; without it all of them are.
std::optional<MapEstimate> maximize_posterior(const Eigen::Isometry3d& guess,
                                              std::span<const SurveyedDot> dots, const CameraModel& camera,
                                              const PoseFixOptions& options,
                                              std::span<const DotsOfMarker> markers = {});

/// Merges two modes from the same dots: the likelier pose, with the covariance of both about it, so that two
/// poses that explain the dots almost equally are covered.
MapEstimate likelier(const MapEstimate& a, const MapEstimate& b);

}  // namespace lodestar
