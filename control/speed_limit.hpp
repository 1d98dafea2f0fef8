#pragma once

#include <Eigen/Core>
#include <limits>

#include "control/drive_options.hpp"
#include "control/forward_clearance.hpp"
#include "control/safety_stop.hpp"

namespace lodestar {

/// What holds for now on top of the robot's own limits.
struct SpeedLimit {
  double forward_mps = std::numeric_limits<double>::infinity();
  double turn_radps = std::numeric_limits<double>::infinity();
};

/// The speed from which the robot comes to rest within the distance: v^2 / (2 a) + latency v = distance.
double speed_to_stop_within(double distance_m, double deceleration_mps2, double latency_s);

/// The larger principal standard deviation of the position, of a covariance of (x_m, y_m, yaw_rad).
double larger_sigma_m(const Eigen::Matrix3d& covariance);

struct CautionOptions {
  double careful_from = 0.4;  ///< share of the uncertainty's limit up to which the robot goes at full speed
  double slowest = 0.15;      ///< share of the full speed that is left just below the limit
  /// So far aside, for each metre, a wheel that slips may lead the robot before it comes to rest.
  double swing_per_m = 0.25;
  /// The same while what is seen contradicts: one may be slipping now.
  double contradicted_swing_per_m = 1.0;
  double creep_mps = 0.1;  ///< not slower than this for that reason alone, however narrow the way
};

/// The share of its full speed that a robot may go at, less the less sure it is: from 1, falling continuously
/// with the larger of position's and heading's share of the limits at which it must stop.
double share_of_speed(const Eigen::Matrix3d& covariance, const SafetyStopOptions& limits,
                      const CautionOptions& options = {});

struct SafeSpeedOptions {
  DriveOptions drive;
  CautionOptions caution;
  SafetyStopOptions limits;
};

/// The less sure of its pose the slower, and never so fast that the robot could not stop before it meets what
/// lies straight ahead, nor, unless it creeps, what a wheel that slips would lead it to.
SpeedLimit safe_speed(const ForwardClearance& way, const PoseEstimate& estimate, const SafetyMargin& spare,
                      const SafeSpeedOptions& options);

}  // namespace lodestar
