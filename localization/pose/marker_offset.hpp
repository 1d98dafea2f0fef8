#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "localization/pose/surveyed_dot.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

// A surveyed marker is not quite where the registry says: its dots share an offset of unknown (x, y, yaw).
namespace lodestar {

/// Consecutive dots that belong to one marker, and how well its place is known.
struct DotsOfMarker {
  std::size_t count = 0;
  Vec2 origin_m = Vec2::Zero();      ///< of dot O in the map: the offset turns about it
  std::optional<MarkerSigma> sigma;  ///< nothing: the place counts as exact
};

/// One marker's part of the normal equations of the camera's pose, in the camera's axes, with the marker's
/// offset eliminated (Schur complement): what its dots say whatever the offset is.
struct DotsWithOffset {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  /// Covariance of the gradient that comes from the offset: all frames of this marker share it.
  Eigen::Matrix<double, 6, 6> shared_of_gradient = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double cost = 0.0;            ///< Huber loss of the dots at the likeliest offset, and the offset's own
  bool is_quadratic = true;     ///< no dot is in the linear range of its Huber loss
  Vec3 offset = Vec3::Zero();   ///< the likeliest, (x_m, y_m, yaw_rad)
  double chi2_of_offset = 0.0;  ///< in squared sigmas of the registry
  double squared_px = 0.0;      ///< sum of the squared residuals at that offset
};

/// Nothing when a dot is behind the camera.
std::optional<DotsWithOffset> eliminate_offset(const Eigen::Isometry3d& map_from_camera,
                                               std::span<const SurveyedDot> dots, const Vec2& origin_m,
                                               const MarkerSigma& sigma, const CameraModel& camera,
                                               double robust_scale);

}  // namespace lodestar
