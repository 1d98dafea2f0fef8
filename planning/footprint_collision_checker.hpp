#pragma once

#include <span>
#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/footprint.hpp"
#include "planning/path_cost.hpp"

namespace lodestar {

/// Where a robot with an outline can stand, drive and turn. In grid coordinates as CollisionChecker, headings
/// in the grid frame. Exact; discs inside and outside of the outline answer most questions quickly.
class FootprintCollisionChecker {
 public:
  /// The map must outlive it.
  FootprintCollisionChecker(const OccupancyMap& map, Footprint footprint);

  /// For the discs about the robot's origin: a place that is not in `inner` is in no heading clear, one that
  /// is in `outer` in all.
  [[nodiscard]] const CollisionChecker& inner() const { return inner_; }
  [[nodiscard]] const CollisionChecker& outer() const { return outer_; }
  [[nodiscard]] const OccupancyMap& map() const { return map_; }
  [[nodiscard]] const Footprint& footprint() const { return footprint_; }

  [[nodiscard]] bool at(const Vec2& point, double heading_rad) const;
  [[nodiscard]] bool driving(const Vec2& from, const Vec2& to) const;                ///< straight ahead
  [[nodiscard]] bool turning(const Vec2& at, double from_rad, double to_rad) const;  ///< the shorter way
  [[nodiscard]] bool along(std::span<const Vec2> points, const EndHeadings& headings) const;

  /// A clear path without those of its points that can be left out.
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
