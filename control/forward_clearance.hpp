#pragma once

#include <memory>
#include <span>
#include <vector>

#include "control/safety_margin.hpp"
#include "maps/footprint.hpp"
#include "maps/geometry.hpp"
#include "maps/obstacle_field.hpp"

namespace lodestar {

/// Clearance straight ahead: how far the robot, a disc or a footprint, can go before it meets a cell that is
/// not drivable.
class ForwardClearance {
 public:
  static constexpr double usual_tolerance_m = 0.03;

  /// `tolerance_m` is subtracted from the disc's radius, for paths that pass at exactly the radius. The
  /// planner on the same map can share its field.
  ForwardClearance(std::shared_ptr<const ObstacleField> field, double radius_m,
                   double tolerance_m = usual_tolerance_m);

  /// For a footprint, made smaller by the tolerance on all sides.
  ForwardClearance(std::shared_ptr<const ObstacleField> field, const Footprint& footprint,
                   double tolerance_m = usual_tolerance_m);

  /// At most `up_to_m`, with the safety margin on all sides. A robot that starts with less than the margin,
  /// or overlaps an obstacle after a small pose error, may move away from the obstacle but not closer.
  [[nodiscard]] double ahead_m(const Pose2& map_from_base, double up_to_m,
                               const SafetyMargin& spare = {}) const;

  /// From the robot's edge, at this pose, to the nearest obstacle; negative when they overlap.
  [[nodiscard]] double room_m(const Pose2& map_from_base) const { return room_m(map_from_base, 0.0); }

 private:
  /// With so much more on all sides.
  [[nodiscard]] double room_m(const Pose2& map_from_base, double more_m) const;
  [[nodiscard]] double room_m(const Vec2& point_in_map, double radius_m) const;
  [[nodiscard]] double exact_distance_m(const Vec2& point_in_map, double radius_m) const;

  std::shared_ptr<const ObstacleField> field_;
  std::vector<InnerDisc> discs_;  ///< together the robot
};

}  // namespace lodestar
