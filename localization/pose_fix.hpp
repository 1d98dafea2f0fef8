#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/detected_marker.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What is known of the camera before looking. Without any of it the pose has six free degrees of freedom.
struct PosePrior {
  /// The camera's roll and pitch as mounted (flat floor), about the x and y axes of the base frame turned to
  /// the camera: the nominal map_from_camera rotation is Rz(yaw) * tilt. Identity: the camera looks straight
  /// up.
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();
  /// Standard deviation of the true tilt about that, for each of the two horizontal axes. Nothing: tilt is
  /// free. 0: exact.
  std::optional<double> tilt_sigma_rad;
  /// Height of the camera in the map frame, and its standard deviation (> 0). Nothing: height is free.
  std::optional<double> height_m;
  double height_sigma_m = 0.005;
};

struct PoseFixOptions {
  PosePrior prior;
  double dot_sigma_px = 0.03;    ///< standard deviation of a dot's centre, for each coordinate
  double max_residual_px = 1.5;  ///< a fix whose dots miss by more (root mean square) is refused
  double robust_scale = 3.0;     ///< Huber's loss starts at so many sigmas
};

/// A pose of the camera in the map, from one frame.
struct PoseFix {
  Stamp stamp;
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  /// Of (x_m, y_m, z_m, rotation about the map's x, y, z axes in rad); zero where the prior is exact.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<int> ids;      ///< of the markers used, the optimal one first
  double confidence = 0.0;   ///< of the optimal marker, Eq. (3)
  int dots = 0;              ///< dots used
  double residual_px = 0.0;  ///< root mean square
};

/// The camera's pose: P3P on the optimal marker's O, X, Y (Eq. (10)-(15)), all roots scored by all dots, then
/// the maximum a posteriori estimate over all dots of all registered markers with the prior. Nothing when no
/// registered marker is among `markers`, or the dots do not agree with any pose.
std::optional<PoseFix> fix_pose(Stamp stamp, const std::vector<DetectedMarker>& markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options);

}  // namespace lodestar
