#pragma once

#include "control/safety_margin.hpp"
#include "maps/distance_field.hpp"
#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Clearance straight ahead: how far the robot's disc can go before it meets a cell that is not drivable.
class ForwardClearance {
 public:
  static constexpr double usual_tolerance_m = 0.03;

  /// `tolerance_m` is subtracted from the disc's radius, for paths that pass at exactly the radius.
  ForwardClearance(const OccupancyMap& map, double radius_m, double tolerance_m = usual_tolerance_m);

  /// At most `up_to_m`, with the safety margin on all sides. A disc that starts with less than the margin, or
  /// overlaps an obstacle after a small pose error, may move away from the obstacle but not closer.
  [[nodiscard]] double ahead_m(const Pose2& map_from_base, double up_to_m,
                               const SafetyMargin& spare = {}) const;

  /// From the disc's edge, at this position, to the nearest obstacle; negative when they overlap.
  [[nodiscard]] double room_m(const Vec2& point_in_map) const { return room_m(point_in_map, radius_m_); }

 private:
  [[nodiscard]] double room_m(const Vec2& point_in_map, double radius_m) const;
  [[nodiscard]] double exact_distance_m(const Vec2& point_in_map, double radius_m) const;

  OccupancyMap map_;
  DistanceField distances_;
  double radius_m_;
};

}  // namespace lodestar
