#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/detected_marker.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What is known of the camera before looking. Without any of it the pose has six free degrees of freedom.
struct PosePrior {
  /// Roll and pitch of the camera as mounted on a base that stands level: nominally
  /// map_from_camera.linear() = Rz(yaw) * tilt with tilt = Ry(pitch) * Rx(roll) and any yaw (that of the
  /// mount is part of it). Identity: the camera looks straight up.
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();
  /// The true rotation is D * Rz(yaw) * tilt, D a small one about a horizontal axis of the map. This is the
  /// standard deviation of its angle about each of two such axes. Nothing: tilt is free. 0: exact.
  std::optional<double> tilt_sigma_rad;
  /// Height of the camera in the map frame, and its standard deviation (> 0). Nothing: height is free.
  std::optional<double> height_m;
  double height_sigma_m = 0.005;
};

struct PoseFixOptions {
  PosePrior prior;
  double dot_sigma_px = 0.03;  ///< standard deviation of a dot's coordinate, where the dot does not tell
  /// How far a dot may be off its place in the marker, in each coordinate: film is cut and glued by hand.
  double dot_place_sigma_m = 0.0;
  /// By what share all dots may lie nearer to the picture's middle than they should, or farther. A ceiling's
  /// light that falls off towards the corners pulls them inwards, by 0.0005 px at 175 px (test
  /// Dots.are_pulled).
  double scale_sigma = 3e-6;
  double max_residual_px = 1.5;  ///< a fix whose dots miss by more (root mean square) is refused
  /// And one that explains the dots only by a tilt and height that the prior all but excludes (chi-square): a
  /// marker that hangs a few centimetres elsewhere than surveyed leaves small residuals on a tilted robot.
  /// With 3 degrees of freedom (two of tilt, height) a true pose goes beyond 30 once in 700,000 frames.
  double max_prior_chi2 = 30.0;
  double robust_scale = 3.0;  ///< Huber's loss starts at so many sigmas
};

/// A pose of the camera in the map, from one frame.
struct PoseFix {
  Stamp stamp;
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  /// Of (x_m, y_m, z_m, rotation about the map's x, y, z axes in rad); zero where the prior is exact.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// The part of it that comes from dots off their places: fixes by the same dots, from about the same place,
  /// share that error.
  Eigen::Matrix<double, 6, 6> shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<int> ids;      ///< of the markers used, the optimal one first
  double confidence = 0.0;   ///< of the optimal marker, Eq. (3)
  int dots = 0;              ///< dots used
  double residual_px = 0.0;  ///< root mean square
};

/// The camera's pose by one frame's markers, as PoseFixer finds it.
std::optional<PoseFix> fix_pose(Stamp stamp, std::span<const DetectedMarker> markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options);

}  // namespace lodestar
