#pragma once

#include <optional>
#include <vector>

#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "planning/convex_pieces.hpp"

namespace lodestar {

/// The robot's footprint: a simple polygon in the robot frame, counter-clockwise, convex or not. All checks
/// are exact; touching is allowed, the outside of the map is not drivable.
class Footprint {
 public:
  /// Throws InputError when the corners are not such a polygon.
  explicit Footprint(std::vector<Vec2> corners_m);

  [[nodiscard]] const std::vector<Vec2>& corners_m() const { return corners_m_; }

  /// Circumscribed radius about the robot's origin: where a disc of this radius is clear, so is the footprint
  /// in any heading.
  [[nodiscard]] double outer_radius_m() const;

  /// Inscribed radius about the robot's origin, 0 when the origin is not inside: where a disc of this radius
  /// is not clear, the footprint is in no heading.
  [[nodiscard]] double inner_radius_m() const;

  /// Is the footprint at this pose clear of cells that are not drivable?
  [[nodiscard]] bool is_clear(const OccupancyMap& map, const Pose2& pose) const;

  /// The same while driving straight, forward or backward. A convex piece sweeps the hull of its two end
  /// positions.
  [[nodiscard]] bool is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const;

  /// The same while turning on the spot the shorter way.
  [[nodiscard]] bool is_clear_turning(const OccupancyMap& map, const Pose2& from, double to_rad) const;

  /// The same for a whole path: turn to each leg, drive it, at the end turn to the final heading if there is
  /// one. Without a start heading the robot already faces along the first leg.
  [[nodiscard]] bool is_clear_along(const OccupancyMap& map, const Path& path,
                                    std::optional<double> start_heading_rad,
                                    std::optional<double> final_heading_rad) const;

  /// The cells that the footprint sweeps on an infinite grid, relative to the robot's cell, from that cell's
  /// centre: driving to the centre of another, or turning by an angle of either sign.
  [[nodiscard]] std::vector<Cell> cells_driving(double resolution_m, double heading_rad, Cell to) const;
  [[nodiscard]] std::vector<Cell> cells_turning(double resolution_m, double heading_rad,
                                                double turn_rad) const;

 private:
  std::vector<Vec2> corners_m_;
  std::vector<Polygon> pieces_m_;  ///< convex; together the footprint
};

}  // namespace lodestar
