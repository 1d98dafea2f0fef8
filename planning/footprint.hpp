#pragma once

#include <optional>
#include <vector>

#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// The robot's outline on the floor: a convex polygon in the robot frame, counter-clockwise.
class Footprint {
 public:
  /// Throws InputError unless there are at least three corners, in counter-clockwise order and convex.
  explicit Footprint(std::vector<Vec2> corners_m);

  [[nodiscard]] const std::vector<Vec2>& corners_m() const { return corners_m_; }

  /// Of the circle about the robot's origin that the outline never leaves, whichever way it turns: a disc of
  /// this radius is planned for when the robot shall be able to turn anywhere.
  [[nodiscard]] double outer_radius_m() const;

  /// Does the outline at this pose overlap no cell that is not drivable? Exact; the outside of the map is not
  /// drivable.
  [[nodiscard]] bool is_clear(const OccupancyMap& map, const Pose2& pose) const;

  /// Driving straight ahead or back from a pose to a place. Exact: what a convex outline sweeps is the hull
  /// of its ends.
  [[nodiscard]] bool is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const;

  /// Turning on the spot the shorter way. In steps so small that no corner moves more than a tenth of a cell,
  /// the outline grown by as much: never clear when it is not.
  [[nodiscard]] bool is_clear_turning(const OccupancyMap& map, const Pose2& from, double to_rad) const;

  /// All of a drive: turn to each leg, drive it, at the end turn to the final heading if there is one.
  [[nodiscard]] bool is_clear_along(const OccupancyMap& map, const Path& path, double start_heading_rad,
                                    std::optional<double> final_heading_rad) const;

 private:
  std::vector<Vec2> corners_m_;
};

}  // namespace lodestar
