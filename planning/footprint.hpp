#pragma once

#include <optional>
#include <vector>

#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "planning/convex_pieces.hpp"

namespace lodestar {

/// The robot's outline on the floor: a simple polygon in the robot frame, counter-clockwise, convex or not.
/// All checks are exact; touching is allowed, the outside of the map is not drivable.
class Footprint {
 public:
  /// Throws InputError unless the corners are those of such a polygon.
  explicit Footprint(std::vector<Vec2> corners_m);

  [[nodiscard]] const std::vector<Vec2>& corners_m() const { return corners_m_; }

  /// Of the circle about the robot's origin that the outline never leaves, whichever way it turns: where a
  /// disc of this radius is clear, so is the outline.
  [[nodiscard]] double outer_radius_m() const;

  /// Of the largest disc about the robot's origin inside the outline, 0 when the origin is not inside: where
  /// this disc is not clear, the outline is not.
  [[nodiscard]] double inner_radius_m() const;

  /// Does the outline at this pose overlap no cell that is not drivable?
  [[nodiscard]] bool is_clear(const OccupancyMap& map, const Pose2& pose) const;

  /// Driving straight ahead or back from a pose to a place. What a convex outline sweeps is the hull of its
  /// ends.
  [[nodiscard]] bool is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const;

  /// Turning on the spot the shorter way.
  [[nodiscard]] bool is_clear_turning(const OccupancyMap& map, const Pose2& from, double to_rad) const;

  /// All of a drive: turn to each leg, drive it, at the end turn to the final heading if there is one.
  /// Without a start heading the robot already looks along the first leg.
  [[nodiscard]] bool is_clear_along(const OccupancyMap& map, const Path& path,
                                    std::optional<double> start_heading_rad,
                                    std::optional<double> final_heading_rad) const;

  /// The cells that the outline overlaps on an endless grid, relative to that in the centre of which the
  /// robot stands: when it drives to the centre of another, or turns by an angle of either sign.
  [[nodiscard]] std::vector<Cell> cells_driving(double resolution_m, double heading_rad, Cell to) const;
  [[nodiscard]] std::vector<Cell> cells_turning(double resolution_m, double heading_rad,
                                                double turn_rad) const;

 private:
  std::vector<Vec2> corners_m_;
  std::vector<Polygon> pieces_m_;  ///< convex, the outline together
};

}  // namespace lodestar
