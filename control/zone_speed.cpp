#include "control/zone_speed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

/// Of a zone's speed, what is commanded in it: wheels that are larger than they were measured, and a speed
/// loop that strays, must not lead above it. Assumed: each 1 %, and 1 % to spare.
constexpr double commanded_share = 0.97;

}  // namespace

double commanded_mps(double limit_mps, const DriveOptions& drive) {
  return std::max(commanded_share * limit_mps, drive.min_forward_mps);
}

/// While the robot brakes steadily it is faster than its command by what it loses in the response time t, and
/// the last of that dies away in about twice that time: ((v + a t)^2 - z^2) / (2 a) + 2 t z = distance.
double speed_before(double then_mps, double distance_m, const DriveOptions& drive) {
  const double deceleration_mps2 = braking_share * drive.max_acceleration_mps2;
  const double braking_m = std::max(distance_m - 2.0 * drive.response_s * then_mps, 0.0);
  const double robot_mps = std::sqrt(square(then_mps) + 2.0 * deceleration_mps2 * braking_m);
  return std::max(robot_mps - deceleration_mps2 * drive.response_s, then_mps);
}

ZoneSpeed::ZoneSpeed(std::vector<SpeedZone> zones, const RobotShape& shape, const DriveOptions& drive)
    : zones_(std::move(zones)), radius_m_(shape.outer_radius_m()), drive_(drive) {}

std::optional<double> ZoneSpeed::limit_mps(const PoseEstimate& estimate) const {
  constexpr double sigmas = 2.3;  // as margin_for_uncertainty
  const double reach_m = radius_m_ + sigmas * larger_sigma(estimate.covariance.topLeftCorner<2, 2>());
  double limit_mps = drive_.max_forward_mps;
  for (const SpeedZone& zone : zones_) {
    const double zone_mps = commanded_mps(zone.max_mps, drive_);
    const double distance_m = distance_to(zone.corners_m, estimate.map_from_base.position_m) - reach_m;
    limit_mps = std::min(limit_mps, speed_before(zone_mps, distance_m, drive_));
  }
  return limit_mps < drive_.max_forward_mps ? std::optional(limit_mps) : std::nullopt;
}

SpeedLimit lowered(SpeedLimit limit, const std::optional<double>& zone_mps) {
  if (!zone_mps) return limit;
  limit.forward_mps = std::min(limit.forward_mps, *zone_mps);
  limit.backward_mps = std::min(limit.backward_mps, *zone_mps);
  return limit;
}

}  // namespace lodestar
