#include "localization/calibration/mount_calibration.hpp"

#include <cmath>

#include "localization/calibration/mount_bundle.hpp"

namespace lodestar {
namespace {

/// Odometry from one frame to the next.
struct Rolled {
  double forward_m = 0.0;
  double turn_rad = 0.0;

  [[nodiscard]] double rim_m(double track_width_m) const { return 0.5 * std::abs(turn_rad) * track_width_m; }
};

Rolled rolled(const MountFrame& from, const MountFrame& to, double track_width_m) {
  const double left_m = to.left_m - from.left_m;
  const double right_m = to.right_m - from.right_m;
  return {0.5 * (left_m + right_m), (right_m - left_m) / track_width_m};
}

std::vector<MountFrame> spaced(std::span<const MountFrame> frames, const MountBelief& belief,
                               const MountCalibrationOptions& options) {
  std::vector<MountFrame> kept;
  for (const MountFrame& frame : frames) {
    if (!kept.empty()) {
      const Rolled since = rolled(kept.back(), frame, belief.track_width_m);
      if (std::abs(since.turn_rad) < options.spacing_rad && std::abs(since.forward_m) < options.spacing_m)
        continue;
    }
    kept.push_back(frame);
  }
  return kept;
}

/// The parts of the drive that determine the mount.
struct Drive {
  std::size_t spin_begin = 0;  ///< frames of the longest stretch of turning on the spot
  std::size_t spin_end = 0;
  double spin_rad = 0.0;
  double straight_m = 0.0;
  Vec2 ahead = Vec2::Zero();  ///< sum of the straight steps, forward, in the camera's level axes
};

/// Ratio of one motion to the other for a step that counts as turning on the spot, or as straight.
constexpr double clear_ratio = 4.0;

bool is_turning(const Rolled& step, double track_width_m) {
  return step.rim_m(track_width_m) > clear_ratio * std::abs(step.forward_m);
}

bool is_straight(const Rolled& step, double track_width_m) {
  return std::abs(step.forward_m) > clear_ratio * step.rim_m(track_width_m);
}

double yaw_of(const MountFrame& frame) {
  return flattened(frame.map_from_camera).yaw_rad;
}

Drive parts_of(std::span<const MountFrame> frames, double track_width_m) {
  Drive drive;
  std::size_t begin = 0;
  double turned_rad = 0.0;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const Rolled step = rolled(frames[i], frames[i + 1], track_width_m);
    if (is_straight(step, track_width_m)) {
      const Vec3 way = frames[i + 1].map_from_camera.translation() - frames[i].map_from_camera.translation();
      drive.straight_m += std::abs(step.forward_m);
      drive.ahead +=
          std::copysign(1.0, step.forward_m) * (Eigen::Rotation2Dd(-yaw_of(frames[i])) * way.head<2>());
    }
    if (!is_turning(step, track_width_m)) {
      begin = i + 1;
      turned_rad = 0.0;
      continue;
    }
    turned_rad += std::abs(step.turn_rad);
    if (turned_rad > drive.spin_rad) {
      drive.spin_rad = turned_rad;
      drive.spin_begin = begin;
      drive.spin_end = i + 2;
    }
  }
  return drive;
}

std::optional<Circle> circle_of(std::span<const MountFrame> frames, const Drive& drive) {
  std::vector<Vec2> points;
  for (std::size_t i = drive.spin_begin; i < drive.spin_end; ++i) {
    points.emplace_back(frames[i].map_from_camera.translation().head<2>());
  }
  return fit_circle(points);
}

/// On the straight the base moves along its own x axis; the camera's yaw on the base is minus the direction
/// of motion in the camera's axes. Without a straight drive, the prior yaw.
double first_yaw(const Drive& drive, const MountBelief& belief) {
  constexpr double least_m = 0.3;  // fixes off by 5 mm give 1 degree: enough for a start
  return drive.ahead.norm() > least_m ? -heading_of(drive.ahead) : belief.angles.yaw_rad;
}

/// Eq. (17): the circle's centre is the base's position, so each frame of the spin gives the camera's offset;
/// their mean is the initial value.
MountState first_state(std::span<const MountFrame> frames, const Drive& drive, const Circle& circle,
                       const MountBelief& belief) {
  MountState state;
  const double yaw_rad = first_yaw(drive, belief);
  state.base_from_camera = rotation_from({belief.angles.roll_rad, belief.angles.pitch_rad, yaw_rad});
  state.track_width_m = belief.track_width_m;
  const auto heading_of = [&](const MountFrame& frame) { return wrap_angle(yaw_of(frame) - yaw_rad); };
  const auto count = static_cast<double>(drive.spin_end - drive.spin_begin);
  for (std::size_t i = drive.spin_begin; i < drive.spin_end; ++i) {
    const Vec3 camera_m = frames[i].map_from_camera.translation();
    const Vec2 offset = Eigen::Rotation2Dd(-heading_of(frames[i])) * (camera_m.head<2>() - circle.center_m);
    state.position_m += Vec3(offset.x(), offset.y(), camera_m.z()) / count;
  }
  for (const MountFrame& frame : frames) {
    const double yaw = heading_of(frame);
    const Vec2 lever = Eigen::Rotation2Dd(yaw) * state.position_m.head<2>();
    state.places.push_back(
        {.position_m = frame.map_from_camera.translation().head<2>() - lever, .yaw_rad = yaw});
  }
  return state;
}

double sigma(const MountSolution& solution, std::size_t unknown) {
  const auto at = static_cast<Eigen::Index>(unknown);
  return std::sqrt(solution.covariance(at, at));
}

/// Fixes what the log does not measure at its prior value. True when there is any such part.
bool keep_unmeasured(const MountSolution& solution, MountProblem& problem, MountState& state) {
  const MountCalibrationOptions& options = problem.options;
  const MountBelief& belief = problem.belief;
  RollPitchYaw angles = angles_of(solution.state.base_from_camera);
  state = solution.state;
  if (sigma(solution, at_z) > options.most_height_sigma_m) {
    problem.fixed[at_z] = true;
    state.position_m.z() = belief.position_m.z();
  }
  if (std::max(sigma(solution, about_x), sigma(solution, about_y)) > options.most_tilt_sigma_rad) {
    problem.fixed[about_x] = problem.fixed[about_y] = true;
    angles.roll_rad = belief.angles.roll_rad;
    angles.pitch_rad = belief.angles.pitch_rad;
  }
  if (sigma(solution, about_z) > options.most_yaw_sigma_rad) {
    // The same camera poses, relative to a rotated base.
    const double turn_rad = wrap_angle(belief.angles.yaw_rad - angles.yaw_rad);
    problem.fixed[about_z] = true;
    angles.yaw_rad = belief.angles.yaw_rad;
    state.position_m = Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()) * state.position_m;
    for (BasePlace& place : state.places) {
      place.yaw_rad = wrap_angle(place.yaw_rad - turn_rad);
      place.wobble_rad = Eigen::Rotation2Dd(turn_rad) * place.wobble_rad;
    }
  }
  state.base_from_camera = rotation_from(angles);
  return problem.fixed[at_z] || problem.fixed[about_x] || problem.fixed[about_z];
}

MountEstimate estimate_of(const MountSolution& solution, const MountProblem& problem) {
  const MountState& state = solution.state;
  MountEstimate estimate{.angles = angles_of(state.base_from_camera), .position_m = state.position_m};
  estimate.position_sigmas_m = {sigma(solution, at_x), sigma(solution, at_y), sigma(solution, at_z)};
  // Roll and pitch are about axes that the yaw has rotated.
  const Eigen::Matrix2d camera_from_base = Eigen::Rotation2Dd(-estimate.angles.yaw_rad).toRotationMatrix();
  const Eigen::Matrix2d tilt =
      camera_from_base * solution.covariance.block<2, 2>(about_x, about_x) * camera_from_base.transpose();
  estimate.angle_sigmas = {std::sqrt(tilt(0, 0)), std::sqrt(tilt(1, 1)), sigma(solution, about_z)};
  estimate.measured_height = !problem.fixed[at_z];
  estimate.measured_tilt = !problem.fixed[about_x];
  estimate.measured_yaw = !problem.fixed[about_z];
  estimate.left_scale = state.left_scale;
  estimate.right_scale = state.right_scale;
  estimate.track_width_m = state.track_width_m;
  estimate.dot_rms_px = solution.dot_rms_px;
  estimate.wheel_rms = solution.wheel_rms;
  return estimate;
}

bool contradicts(const MountEstimate& estimate, const MountBelief& belief,
                 const MountCalibrationOptions& options) {
  constexpr double clearly = 5.0;  // standard deviations
  const double most = clearly * options.wheel_scale_sigma;
  const auto is_off = [most](double scale) { return std::abs(scale - 1.0) > most; };
  return estimate.dot_rms_px > options.most_dot_rms_px || estimate.wheel_rms > options.most_wheel_rms ||
         is_off(estimate.left_scale) || is_off(estimate.right_scale) ||
         is_off(estimate.track_width_m / belief.track_width_m);
}

/// Solves for all unknowns; then fixes what is uncertain at its prior value and solves again.
std::optional<MountEstimate> full_estimate(MountProblem problem, MountState state) {
  std::optional<MountSolution> solution = solve_mount(problem, state);
  if (!solution) return std::nullopt;
  if (keep_unmeasured(*solution, problem, state)) solution = solve_mount(problem, state);
  if (!solution) return std::nullopt;
  return estimate_of(*solution, problem);
}

}  // namespace

std::string_view to_string(MountFlaw flaw) {
  switch (flaw) {
    case MountFlaw::too_few_fixes:
      return "too-few-fixes";
    case MountFlaw::too_few_turns:
      return "too-few-turns";
    case MountFlaw::offset_undetermined:
      return "offset-undetermined";
    case MountFlaw::contradiction:
      return "contradiction";
  }
  return "";
}

MountCalibration calibrate_mount(std::span<const MountFrame> frames, const CameraModel& camera,
                                 const MountBelief& belief, const MountCalibrationOptions& options) {
  const std::vector<MountFrame> used = spaced(frames, belief, options);
  const Drive drive = parts_of(used, belief.track_width_m);
  MountCalibration result{.frames = used.size(),
                          .turns = drive.spin_rad / (2.0 * std::numbers::pi),
                          .straight_m = drive.straight_m,
                          .circle = circle_of(used, drive)};
  const auto refuse_if = [&result](bool flawed, MountFlaw flaw) {
    if (flawed) result.flaws.push_back(flaw);
  };
  refuse_if(used.size() < options.least_frames, MountFlaw::too_few_fixes);
  refuse_if(result.turns < options.least_turns, MountFlaw::too_few_turns);
  if (!result.flaws.empty() || !result.circle) {
    refuse_if(result.flaws.empty(), MountFlaw::contradiction);  // odometry turned, the camera did not
    return result;
  }
  result.estimate = full_estimate({.frames = used, .camera = camera, .belief = belief, .options = options},
                                  first_state(used, drive, *result.circle, belief));
  if (!result.estimate) {
    refuse_if(true, MountFlaw::contradiction);
    return result;
  }
  const MountEstimate& estimate = *result.estimate;
  refuse_if(estimate.position_sigmas_m.head<2>().maxCoeff() > options.most_offset_sigma_m,
            MountFlaw::offset_undetermined);
  refuse_if(contradicts(estimate, belief, options), MountFlaw::contradiction);
  return result;
}

}  // namespace lodestar
