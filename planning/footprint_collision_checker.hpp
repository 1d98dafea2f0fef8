#pragma once

#include <span>
#include <vector>

#include "maps/footprint.hpp"
#include "planning/collision_checker.hpp"
#include "planning/path_cost.hpp"

namespace lodestar {

/// Exact collision checks for a robot's footprint, in grid coordinates as CollisionChecker, headings in the
/// grid frame. The inscribed and the circumscribed disc decide most checks quickly.
class FootprintCollisionChecker {
 public:
  /// The map must outlive it.
  FootprintCollisionChecker(const OccupancyMap& map, Footprint footprint);

  /// The checkers of the inscribed and the circumscribed disc: a position blocked in `inner` is blocked in
  /// every heading, one clear in `outer` is clear in every heading.
  [[nodiscard]] const CollisionChecker& inner() const { return inner_; }
  [[nodiscard]] const CollisionChecker& outer() const { return outer_; }
  [[nodiscard]] const OccupancyMap& map() const { return map_; }
  [[nodiscard]] const Footprint& footprint() const { return footprint_; }

  [[nodiscard]] bool at(const Vec2& point, double heading_rad) const;
  [[nodiscard]] bool driving(const Vec2& from, const Vec2& to) const;                ///< straight ahead
  [[nodiscard]] bool turning(const Vec2& at, double from_rad, double to_rad) const;  ///< the shorter way
  [[nodiscard]] bool along(std::span<const Vec2> points, const EndHeadings& headings) const;

  /// A clear path without the points that it can do without and stay clear.
  [[nodiscard]] std::vector<Vec2> with_fewer_legs(std::vector<Vec2> points,
                                                  const EndHeadings& headings) const;

 private:
  [[nodiscard]] Pose2 in_map(const Vec2& point, double heading_rad) const;

  const OccupancyMap& map_;
  Footprint footprint_;
  CollisionChecker inner_;
  CollisionChecker outer_;
};

}  // namespace lodestar
