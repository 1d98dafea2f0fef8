#include "control/safety_stop.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lodestar {
namespace {

/// A broken covariance, not finite or with a negative variance, counts as uncertain.
bool is_certain(const Eigen::Matrix3d& covariance, const SafetyStopOptions& options) {
  if (!covariance.allFinite()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>(),
                                                              Eigen::EigenvaluesOnly);
  const double rounding = 1e-12;
  return solver.eigenvalues()[0] >= -rounding && covariance(2, 2) >= -rounding &&
         solver.eigenvalues()[1] <= options.max_position_sigma_m * options.max_position_sigma_m &&
         covariance(2, 2) <= options.max_heading_sigma_rad * options.max_heading_sigma_rad;
}

}  // namespace

std::string_view to_string(StopReason reason) {
  switch (reason) {
    case StopReason::no_pose:
      return "the pose is not known";
    case StopReason::pose_stale:
      return "no marker was seen for too long";
    case StopReason::pose_uncertain:
      return "the pose is too uncertain";
    case StopReason::base_silent:
      return "the base is silent";
    case StopReason::way_blocked:
      return "the way is blocked";
    case StopReason::person_near:
      return "a person is too near";
    case StopReason::obstacle_ahead:
      return "something that is not on the map stands in the way";
    case StopReason::hidden_corner:
      return "a person could step out from behind a corner";
    case StopReason::scanner_silent:
      return "the scanner sends no scans";
    case StopReason::scanner_clock:
      return "the scanner's clock is not the robot's";
    case StopReason::scanner_late:
      return "the scanner's scans come too late";
    case StopReason::scanner_repeats:
      return "the scanner repeats the same scan";
    case StopReason::scanner_damaged:
      return "the scanner's data arrive damaged";
    case StopReason::scanner_motor:
      return "the scanner does not turn at its speed";
    case StopReason::scanner_dirty:
      return "the scanner's window is dirty or covered";
    case StopReason::scanner_blind:
      return "too many of the scanner's beams are lost";
    case StopReason::scanner_turned:
      return "the scanner is turned on its mount";
    case StopReason::depth_silent:
      return "the depth camera sends no new images";
    case StopReason::map_contradicted:
      return "the scanner sees through walls of the map";
    case StopReason::camera_silent:
      return "the camera sends no frames";
    case StopReason::camera_repeats:
      return "the camera repeats the same picture";
    case StopReason::camera_dark:
      return "the camera sees nothing but black";
    case StopReason::camera_bright:
      return "the camera sees nothing but white";
    case StopReason::camera_late:
      return "the camera's frames come too late";
    case StopReason::camera_clock:
      return "the camera's clock is not the robot's";
    case StopReason::contradicted:
      return "the markers say that the robot is elsewhere";
    case StopReason::pose_moved:
      return "the pose has just been corrected";
    case StopReason::wheels_wrong:
      return "the wheels say otherwise than the markers";
    case StopReason::carried_away:
      return "the robot is not where it was believed to be, as if it had been put elsewhere: start it again";
    case StopReason::wheels_broken:
      return "the wheels cannot be believed: start the robot again";
  }
  return "";
}

bool is_latched(StopReason reason) {
  return reason == StopReason::carried_away || reason == StopReason::wheels_broken;
}

bool waits_for_others(StopReason reason) {
  return reason == StopReason::person_near || reason == StopReason::obstacle_ahead ||
         reason == StopReason::hidden_corner;
}

bool can_a_marker_end(StopReason reason) {
  return reason == StopReason::no_pose || reason == StopReason::pose_stale ||
         reason == StopReason::pose_uncertain;
}

std::optional<StopReason> reason_to_stop(Stamp now, const std::optional<PoseEstimate>& estimate,
                                         const SafetyStopOptions& options) {
  if (!estimate) return StopReason::no_pose;
  if (now - estimate->stamp > options.max_travel_age) return StopReason::base_silent;
  if (now - estimate->last_agreed > options.max_time_unseen) return StopReason::pose_stale;
  const bool finite =
      estimate->map_from_base.position_m.allFinite() && std::isfinite(estimate->map_from_base.yaw_rad);
  if (!finite || !is_certain(estimate->covariance, options)) return StopReason::pose_uncertain;
  return std::nullopt;
}

}  // namespace lodestar
