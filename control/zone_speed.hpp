#pragma once

#include <optional>
#include <vector>

#include "control/drive_options.hpp"
#include "control/speed_limit.hpp"
#include "maps/motion.hpp"
#include "maps/robot_shape.hpp"
#include "maps/zones.hpp"

namespace lodestar {

/// The speed that a map's zones allow a robot, taken for the smallest disc about its base frame that holds
/// it.
class ZoneSpeed {
 public:
  ZoneSpeed(std::vector<SpeedZone> zones, const RobotShape& shape, const DriveOptions& drive);

  /// Nothing where it is not less than the robot can. While any part of the robot may be in a zone (its disc
  /// grown by 2.3 standard deviations of the position) that is 3 % below the zone's; before it, what the
  /// robot brakes from to that by the border, whichever way it drives.
  [[nodiscard]] std::optional<double> limit_mps(const PoseEstimate& estimate) const;

 private:
  std::vector<SpeedZone> zones_;
  double radius_m_ = 0.0;
  DriveOptions drive_;
};

/// The speed to command in order to keep to a limit: 3 % below it, and never below the motors' dead band.
double commanded_mps(double limit_mps, const DriveOptions& drive);

/// The speed from which the robot brakes to this one within the distance.
double speed_before(double then_mps, double distance_m, const DriveOptions& drive);

/// The limit, lowered to what a zone allows ahead and back.
SpeedLimit lowered(SpeedLimit limit, const std::optional<double>& zone_mps);

}  // namespace lodestar
