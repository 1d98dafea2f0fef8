#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "localization/pose/surveyed_dot.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

// A surveyed marker is not quite where the registry says: its dots share an offset of unknown (x, y, yaw),
// and a tilt.
namespace lodestar {

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat65 = Eigen::Matrix<double, 6, 5>;

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
  /// What is left of the offset in the gradient, which all frames of this marker share: the gradient is off
  /// by this times the offset in sigmas.
  Mat65 gradient_by_offset = Mat65::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double cost = 0.0;         ///< Huber loss of the dots at the likeliest offset, and the offset's own
  bool is_quadratic = true;  ///< no dot is in the linear range of its Huber loss
  /// The likeliest: x_m, y_m, and rotations about the map's z, x and y axes through dot O in rad.
  Vec5 offset = Vec5::Zero();
  double chi2_of_offset = 0.0;  ///< in squared sigmas of the registry
  double squared_px = 0.0;      ///< sum of the squared residuals at that offset
};

/// Nothing when a dot is behind the camera.
std::optional<DotsWithOffset> eliminate_offset(const Eigen::Isometry3d& map_from_camera,
                                               std::span<const SurveyedDot> dots, const Vec2& origin_m,
                                               const MarkerSigma& sigma, const CameraModel& camera,
                                               double robust_scale);

}  // namespace lodestar
