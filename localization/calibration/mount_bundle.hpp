#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "localization/calibration/mount_calibration.hpp"

// The least-squares problem behind calibrate_mount().
namespace lodestar {

/// Unknowns shared by all frames. Rotations of the mount are about the base's axes.
enum MountUnknown : std::size_t {
  at_x,
  at_y,
  at_z,
  about_x,
  about_y,
  about_z,
  left_scale,
  right_scale,
  track
};
inline constexpr std::size_t mount_unknowns = 9;

/// The base's pose in one frame, and the lean of its body.
struct BasePlace {
  Vec2 position_m = Vec2::Zero();
  double yaw_rad = 0.0;
  Vec2 wobble_rad = Vec2::Zero();  ///< about the base's x and y axes
};

struct MountState {
  Vec3 position_m = Vec3::Zero();
  Eigen::Matrix3d base_from_camera = Eigen::Matrix3d::Identity();  ///< rotation
  double left_scale = 1.0;
  double right_scale = 1.0;
  double track_width_m = 0.4;
  std::vector<BasePlace> places;  ///< one for each frame
};

struct MountSolution {
  MountState state;
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();  ///< zero where fixed
  double dot_rms_px = 0.0;
  double wheel_rms = 0.0;  ///< in standard deviations
};

/// Input of the bundle adjustment.
struct MountProblem {
  std::span<const MountFrame> frames;
  const CameraModel& camera;
  MountBelief belief;
  MountCalibrationOptions options;
  std::array<bool, mount_unknowns> fixed{};  ///< kept at their start values
};

/// Levenberg-Marquardt with sparse normal equations. Nothing when dots get behind the camera or the equations
/// have no solution. The covariance is for the noise of the options, or for that of the residuals if larger.
std::optional<MountSolution> solve_mount(const MountProblem& problem, const MountState& start);

}  // namespace lodestar
