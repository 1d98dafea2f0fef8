#include "control/safety_stop.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lodestar {
namespace {

/// Asked so that a broken covariance, not finite or with a variance below zero, counts as uncertain.
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
  }
  return "";
}

std::optional<StopReason> reason_to_stop(Stamp now, const std::optional<PoseEstimate>& estimate,
                                         const SafetyStopOptions& options) {
  if (!estimate) return StopReason::no_pose;
  if (now - estimate->stamp > options.max_travel_age) return StopReason::base_silent;
  if (now - estimate->last_fix > options.max_time_without_fix) return StopReason::pose_stale;
  const bool finite =
      estimate->map_from_base.position_m.allFinite() && std::isfinite(estimate->map_from_base.yaw_rad);
  if (!finite || !is_certain(estimate->covariance, options)) return StopReason::pose_uncertain;
  return std::nullopt;
}

}  // namespace lodestar
