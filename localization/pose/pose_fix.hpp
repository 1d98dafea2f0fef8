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

/// Prior of the camera's pose. Without any of it the pose has six degrees of freedom.
struct PosePrior {
  /// Roll and pitch of the camera as mounted on a level base: nominally map_from_camera.linear() = Rz(yaw) *
  /// tilt with tilt = Ry(pitch) * Rx(roll) and any yaw (which includes the mount's). Identity: the camera
  /// looks straight up.
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Identity();
  /// The true rotation is D * Rz(yaw) * tilt, with D a small rotation about a horizontal axis of the map.
  /// This is the standard deviation of its angle about each of two such axes. Nothing: tilt is free. 0:
  /// exact.
  std::optional<double> tilt_sigma_rad;
  /// Height of the camera in the map frame, and its standard deviation (> 0). Nothing: height is free.
  std::optional<double> height_m;
  double height_sigma_m = 0.005;
};

struct PoseFixOptions {
  PosePrior prior;
  double dot_sigma_px = 0.03;  ///< standard deviation of a dot's coordinate, for dots without their own
  /// Standard deviation of a dot's position in its marker, per coordinate: film is cut and glued by hand.
  double dot_place_sigma_m = 0.0;
  MarkerSigma unstated_sigma;  ///< of a marker of which the registry does not say how well it knows it
  /// Standard deviation of a marker's tilt about each horizontal axis: no ceiling is quite level. It looks
  /// like a tilt of the camera, in one marker.
  double marker_tilt_sigma_rad = 0.0;
  /// Standard deviation of a common scale error of the image about its centre. Ceiling light that falls off
  /// towards the corners pulls dots inwards, by 0.0005 px at 175 px (test Dots.are_pulled).
  double scale_sigma = 3e-6;
  double max_residual_px = 1.5;  ///< fixes with a larger root mean square reprojection error are refused
  /// Fixes whose tilt and height the prior all but excludes (chi-square) are refused: a marker displaced by a
  /// few centimetres leaves small residuals on a tilted robot. With 3 degrees of freedom (two of tilt,
  /// height) a true pose exceeds 30 once in 700,000 frames.
  double max_prior_chi2 = 30.0;
  /// A marker farther from its registered place than its sigmas allow (chi-square of x, y and yaw) is
  /// displaced.
  double max_offset_chi2 = 30.0;
  double robust_scale = 3.0;  ///< Huber loss is linear beyond this, in sigmas
};

/// What a marker's offset from its registered place moves a fix by: `jacobian` (in the axes of its
/// covariance) times the offset in its sigmas (x, y, rotations about the map's z, x and y axes). The offset
/// is the same in all fixes of the marker, while what it does to them depends on where they are taken.
struct PoseByOffset {
  int id = 0;
  Eigen::Matrix<double, 6, 5> jacobian;
};

/// Markers of a frame whose offsets a fix knows one by one.
inline constexpr int most_offsets_of_fix = 8;

/// Camera pose in the map, from one frame.
struct PoseFix {
  Stamp stamp;
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  /// Of (x_m, y_m, z_m, rotation about the map's x, y, z axes in rad); zero where the prior is exact.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// The part of it from displaced dots and markers: fixes by the same ones, from about the same place, share
  /// that error.
  Eigen::Matrix<double, 6, 6> shared_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the first markers whose places are not known exactly; a part of what the covariance shares.
  std::vector<PoseByOffset> by_offsets;
  std::vector<int> ids;      ///< of the markers used, the optimal one first
  double confidence = 0.0;   ///< of the optimal marker, Eq. (3)
  int dots = 0;              ///< dots used
  double residual_px = 0.0;  ///< root mean square, with markers where they most likely are
};

/// Camera pose from one frame's markers, as by PoseFixer.
std::optional<PoseFix> fix_pose(Stamp stamp, std::span<const DetectedMarker> markers,
                                const MarkerRegistry& registry, const CameraModel& camera,
                                const PoseFixOptions& options);

}  // namespace lodestar
