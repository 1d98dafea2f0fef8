#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "localization/pose/map_estimate.hpp"
#include "localization/pose/mount.hpp"
#include "maps/camera_model.hpp"

// Calibrates the camera's mount on the base, from a log of five turns on the spot and a straight drive.
namespace lodestar {

/// One frame of the log: the registered dots in view, the pose from them alone, and the wheels' travel by
/// then.
struct MountFrame {
  std::vector<SurveyedDot> dots;
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  double left_m = 0.0;
  double right_m = 0.0;
};

/// Prior: the robot file's mount and track width.
struct MountBelief {
  RollPitchYaw angles;  ///< the camera's rotation on the base: Rz(yaw) Ry(pitch) Rx(roll)
  Vec3 position_m = Vec3::Zero();
  double track_width_m = 0.4;
  double wobble_sigma_rad = radians(0.1);  ///< of the body on the floor, about each axis
};

/// Why a log does not calibrate the mount.
enum class MountFlaw {
  too_few_fixes,        ///< too few frames with registered markers
  too_few_turns,        ///< too little turning on the spot
  offset_undetermined,  ///< the standard deviation of the camera's offset is too large
  contradiction         ///< dots, registry and odometry are inconsistent
};

/// Name in results: `too-few-turns`.
std::string_view to_string(MountFlaw flaw);

struct MountCalibrationOptions {
  double spacing_rad = radians(6.0);  ///< a frame is used after a turn by this since the last one used,
  double spacing_m = 0.04;            ///< or after a drive by this
  std::size_t least_frames = 40;
  double least_turns = 2.0;
  double dot_sigma_px = 0.03;
  double slip_sigma_per_sqrt_m = 0.003;      ///< random slip of each wheel
  double sideways_sigma_per_sqrt_m = 0.001;  ///< lateral slip of the base
  double encoder_sigma_m = 0.0005;
  double wheel_scale_sigma = 0.02;  ///< prior of the wheels' scales and the track width
  double most_offset_sigma_m = 0.003;
  // A part with a larger standard deviation is not measured and keeps its prior value.
  double most_height_sigma_m = 0.005;
  double most_tilt_sigma_rad = radians(0.1);
  double most_yaw_sigma_rad = radians(0.3);
  double most_dot_rms_px = 1.0;  ///< above it, the registry or the camera model is wrong
  double most_wheel_rms = 4.0;   ///< in standard deviations; above it, odometry contradicts the frames
};

/// The mount, as far as the log determines it.
struct MountEstimate {
  RollPitchYaw angles;
  Vec3 position_m = Vec3::Zero();
  RollPitchYaw angle_sigmas;  ///< 0 for parts that keep their prior value
  Vec3 position_sigmas_m = Vec3::Zero();
  bool measured_height = false;
  bool measured_tilt = false;
  bool measured_yaw = false;
  double left_scale = 1.0;  ///< true travel over reported travel
  double right_scale = 1.0;
  double track_width_m = 0.0;
  double dot_rms_px = 0.0;
  double wheel_rms = 0.0;  ///< in standard deviations
};

/// Result of a log. The estimate may be used when there are no flaws.
struct MountCalibration {
  std::size_t frames = 0;  ///< used
  double turns = 0.0;      ///< on the spot, in the longest spin
  double straight_m = 0.0;
  std::optional<Circle> circle;  ///< the camera's path in this spin, Eq. (17)
  std::optional<MountEstimate> estimate;
  std::vector<MountFlaw> flaws;
};

/// Starts from the circle of Eq. (17) and solves the least squares over all dots and wheel readings for the
/// mount, the wheels' scales and, for each frame, the base's position, heading and wobble. Frames are in
/// order of time.
///
/// The standard deviations decide what is measured: turning on the spot gives the offset in the camera's axes
/// but never the yaw, which needs a straight drive; the tilt needs dots that show it by perspective, in
/// single frames, over their places in the image while the robot turns, or by markers at several heights. A
/// part that is not measured keeps its prior value, and the rest is solved with it fixed.
MountCalibration calibrate_mount(std::span<const MountFrame> frames, const CameraModel& camera,
                                 const MountBelief& belief, const MountCalibrationOptions& options = {});

}  // namespace lodestar
