#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "localization/pose/map_estimate.hpp"
#include "localization/pose/mount.hpp"
#include "maps/camera_model.hpp"

// Where the camera sits on the base, from a log of five turns on the spot and a straight drive.
namespace lodestar {

/// One frame of the log: the registered dots in view, the pose that they give by themselves, and how far the
/// wheels had rolled by then.
struct MountFrame {
  std::vector<SurveyedDot> dots;
  Eigen::Isometry3d map_from_camera = Eigen::Isometry3d::Identity();
  double left_m = 0.0;
  double right_m = 0.0;
};

/// What is believed before: the robot file's mount and track width.
struct MountBelief {
  RollPitchYaw angles;  ///< the camera's rotation on the base: Rz(yaw) Ry(pitch) Rx(roll)
  Vec3 position_m = Vec3::Zero();
  double track_width_m = 0.4;
  double wobble_sigma_rad = radians(0.1);  ///< of the body on the floor, each axis
};

/// Why a log does not calibrate the mount.
enum class MountFlaw {
  too_few_fixes,        ///< registered markers were seen in too few places
  too_few_turns,        ///< no turning on the spot that is long enough
  offset_undetermined,  ///< the offset of the camera stays too uncertain
  contradiction         ///< dots, registry and wheels do not fit together
};

/// As it is named in results: `too-few-turns`.
std::string_view to_string(MountFlaw flaw);

struct MountCalibrationOptions {
  double spacing_rad = radians(6.0);  ///< frames nearer to the last one that was used are left out: turned
  double spacing_m = 0.04;            ///< or driven by less
  std::size_t least_frames = 40;
  double least_turns = 2.0;
  double dot_sigma_px = 0.03;
  double slip_sigma_per_sqrt_m = 0.003;      ///< of the ground covered, each wheel
  double sideways_sigma_per_sqrt_m = 0.001;  ///< of the base
  double encoder_sigma_m = 0.0005;
  double wheel_scale_sigma = 0.02;  ///< how unequal wheels, and the track width, may be before looking
  double most_offset_sigma_m = 0.003;
  // A part whose standard deviation is larger is not measured: it keeps what was believed.
  double most_height_sigma_m = 0.005;
  double most_tilt_sigma_rad = radians(0.1);
  double most_yaw_sigma_rad = radians(0.3);
  double most_dot_rms_px = 1.0;  ///< beyond, registry or camera are wrong
  double most_wheel_rms = 4.0;   ///< in standard deviations; beyond, the wheels tell of another drive
};

/// The mount as far as the log tells it.
struct MountEstimate {
  RollPitchYaw angles;
  Vec3 position_m = Vec3::Zero();
  RollPitchYaw angle_sigmas;  ///< 0 for what was kept as believed
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

/// What a log tells. The estimate may be used when there are no flaws.
struct MountCalibration {
  std::size_t frames = 0;  ///< that were used
  double turns = 0.0;      ///< on the spot, in the longest stretch of turning
  double straight_m = 0.0;
  std::optional<Circle> circle;  ///< where the camera went meanwhile, Eq. (17)
  std::optional<MountEstimate> estimate;
  std::vector<MountFlaw> flaws;
};

/// The circle of Eq. (17) first; from there the least squares over all dots and wheel readings of the mount,
/// the wheels' sizes and, for each frame, the base's place, heading and wobble. Frames are in the order of
/// time.
///
/// What is measured follows from the standard deviations: turning on the spot gives the offset in the
/// camera's own directions but never the yaw, which takes a straight drive; the tilt takes dots that show it
/// by perspective, in single frames, over the place that they take in the image while the robot turns, or by
/// markers at several heights. A part that is not measured keeps what was believed, and the rest is measured
/// as if that were true.
MountCalibration calibrate_mount(std::span<const MountFrame> frames, const CameraModel& camera,
                                 const MountBelief& belief, const MountCalibrationOptions& options = {});

}  // namespace lodestar
