#include "control/speed_limit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lodestar {

double speed_to_stop_within(double distance_m, double deceleration_mps2, double latency_s) {
  const double lost_mps = deceleration_mps2 * latency_s;
  return std::sqrt(lost_mps * lost_mps + 2.0 * deceleration_mps2 * std::max(distance_m, 0.0)) - lost_mps;
}

double share_of_speed(const Eigen::Matrix3d& covariance, const SafetyStopOptions& limits,
                      const CautionOptions& options) {
  const double position = larger_sigma(covariance.topLeftCorner<2, 2>()) / limits.max_position_sigma_m;
  const double heading = std::sqrt(std::max(covariance(2, 2), 0.0)) / limits.max_heading_sigma_rad;
  const double beyond = (std::max(position, heading) - options.careful_from) / (1.0 - options.careful_from);
  return std::lerp(1.0, options.slowest, std::clamp(beyond, 0.0, 1.0));
}

SpeedLimit safe_speed(const ForwardClearance& way, const PoseEstimate& estimate, const SafetyMargin& spare,
                      const SafeSpeedOptions& options) {
  const auto& [drive, caution, limits] = options;
  const double deceleration = braking_share * drive.max_acceleration_mps2;
  const double reach_m =
      drive.max_forward_mps * (drive.response_s + 0.5 * drive.max_forward_mps / deceleration);
  const auto speed_with = [&](const SafetyMargin& kept) {
    const double free_m = way.ahead_m(estimate.map_from_base, reach_m, kept);
    return speed_to_stop_within(free_m, deceleration, drive.response_s);
  };
  const double swinging_mps =
      speed_with({.here_m = ForwardClearance::usual_tolerance_m, .per_m = caution.swing_per_m});
  const double share = share_of_speed(estimate.covariance, limits, caution);
  return {.forward_mps = std::min(
              {share * drive.max_forward_mps, speed_with(spare), std::max(swinging_mps, caution.creep_mps)}),
          .turn_radps = share * drive.max_turn_radps};
}

}  // namespace lodestar
