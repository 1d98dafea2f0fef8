#pragma once

#include <optional>
#include <vector>

#include "maps/convex_pieces.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// In the robot frame.
struct InnerDisc {
  Vec2 center_m = Vec2::Zero();
  double radius_m = 0.0;
};

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

  /// Discs that together are the footprint made smaller by `less_m` on all sides, to 1 cm or 2 % of the outer
  /// radius. A part thinner than that is kept as its middle line. At least one.
  [[nodiscard]] std::vector<InnerDisc> inner_discs(double less_m) const;

  /// Is the footprint at this pose clear of cells that are not drivable?
  [[nodiscard]] bool is_clear(const OccupancyMap& map, const Pose2& pose) const;

  /// The same while driving straight, forward or backward. A convex piece sweeps the hull of its two end
  /// positions.
  [[nodiscard]] bool is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const;

  /// The same while turning on the spot the shorter way; within 3 degrees of half a turn, while turning
  /// either way.
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
  [[nodiscard]] bool is_clear_sweeping(const OccupancyMap& map, const Pose2& from, double turn_rad) const;

  [[nodiscard]] double depth_m(const Vec2& point_m) const;
  [[nodiscard]] std::vector<InnerDisc> discs_on_lattice(double spacing_m) const;

  std::vector<Vec2> corners_m_;
  std::vector<Polygon> pieces_m_;  ///< convex; together the footprint
};

}  // namespace lodestar
