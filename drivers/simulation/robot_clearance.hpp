#pragma once

#include <optional>

#include "maps/footprint.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// The robot as the judge measures it, edge to edge: a disc, or the footprint if there is one.
class RobotClearance {
 public:
  RobotClearance(const OccupancyMap& map, double robot_radius_m, std::optional<Footprint> footprint);

  /// The room between the robot and a disc; negative when they overlap.
  [[nodiscard]] double to_disc_m(const Pose2& map_from_base, const Vec2& center_m, double radius_m) const;

  /// The room between the robot and the nearest cell that is not drivable, 0 when they overlap; nothing when
  /// it is `most_m` or more. The edge of the map is no obstacle here.
  [[nodiscard]] std::optional<double> to_map_m(const Pose2& map_from_base, double most_m) const;

  /// From the robot's origin to the farthest point of its edge.
  [[nodiscard]] double outer_radius_m() const;

 private:
  [[nodiscard]] double to_cell_m(const Pose2& map_from_base, Cell cell) const;

  OccupancyMap map_;
  double robot_radius_m_;
  std::optional<Footprint> footprint_;
};

}  // namespace lodestar
