#pragma once

#include "control/safety_margin.hpp"
#include "maps/distance_field.hpp"
#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// How far the robot's disc can go straight ahead before it meets something that is not drivable.
class ForwardClearance {
 public:
  static constexpr double usual_tolerance_m = 0.03;

  /// `tolerance_m`: the disc is taken to be smaller by so much, for paths that pass at exactly its radius.
  ForwardClearance(const OccupancyMap& map, double radius_m, double tolerance_m = usual_tolerance_m);

  /// At most `up_to_m`, with some room kept on all sides. A disc that overlaps something already, as after a
  /// pose that was a little off, has a way out of it but none deeper into it; so has one that has less room
  /// than is to be kept.
  [[nodiscard]] double ahead_m(const Pose2& map_from_base, double up_to_m,
                               const SafetyMargin& spare = {}) const;

  /// From the rim of a disc at this place to the nearest obstacle; less than zero where they overlap.
  [[nodiscard]] double room_m(const Vec2& point_in_map) const { return room_m(point_in_map, radius_m_); }

 private:
  [[nodiscard]] double room_m(const Vec2& point_in_map, double radius_m) const;
  [[nodiscard]] double exact_distance_m(const Vec2& point_in_map, double radius_m) const;

  OccupancyMap map_;
  DistanceField distances_;
  double radius_m_;
};

}  // namespace lodestar
