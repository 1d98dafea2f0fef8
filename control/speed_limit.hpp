#pragma once

#include <Eigen/Core>
#include <limits>

#include "control/drive_options.hpp"
#include "control/forward_clearance.hpp"
#include "control/safety_stop.hpp"

namespace lodestar {

/// Temporary limits on top of the robot's own.
struct SpeedLimit {
  double forward_mps = std::numeric_limits<double>::infinity();
  double turn_radps = std::numeric_limits<double>::infinity();
  double backward_mps = std::numeric_limits<double>::infinity();
};

/// The speed from which the robot brakes to rest within the distance: v^2 / (2 a) + latency v = distance.
double speed_to_stop_within(double distance_m, double deceleration_mps2, double latency_s);

struct CautionOptions {
  double careful_from = 0.4;  ///< share of the uncertainty limit up to which the robot drives at full speed
  double slowest = 0.15;      ///< share of the full speed at the uncertainty limit
  /// Lateral drift allowed for wheel slip before the robot comes to rest, metres per metre.
  double swing_per_m = 0.25;
  /// The same while fixes contradict the estimate: a wheel may be slipping now.
  double contradicted_swing_per_m = 1.0;
  double creep_mps = 0.1;  ///< the drift allowance does not reduce the speed below this
};

/// The allowed share of full speed: 1 for a certain pose, falling linearly beyond careful_from with the ratio
/// sigma / stop limit, the larger of position's and heading's.
double share_of_speed(const Eigen::Matrix3d& covariance, const SafetyStopOptions& limits,
                      const CautionOptions& options = {});

struct SafeSpeedOptions {
  DriveOptions drive;
  CautionOptions caution;
  SafetyStopOptions limits;
};

/// Reduces the speed with the pose uncertainty, and so that the robot can stop before an obstacle straight
/// ahead or, above creep_mps, before one that wheel slip would lead it to.
SpeedLimit safe_speed(const ForwardClearance& way, const PoseEstimate& estimate, const SafetyMargin& spare,
                      const SafeSpeedOptions& options);

}  // namespace lodestar
