#include "planning/footprint_collision_checker.hpp"

#include <cmath>

#include "planning/path_shortening.hpp"

namespace lodestar {

FootprintCollisionChecker::FootprintCollisionChecker(const OccupancyMap& map, Footprint footprint)
    : map_(map),
      footprint_(std::move(footprint)),
      inner_(map, footprint_.inner_radius_m()),
      outer_(inner_.shared_field(), footprint_.outer_radius_m()) {}

Pose2 FootprintCollisionChecker::in_map(const Vec2& point, double heading_rad) const {
  return map_.map_from_grid * Pose2{point * map_.resolution_m, heading_rad};
}

bool FootprintCollisionChecker::at(const Vec2& point, double heading_rad) const {
  if (outer_.along(point, point)) return true;
  return inner_.along(point, point) && footprint_.is_clear(map_, in_map(point, heading_rad));
}

bool FootprintCollisionChecker::driving(const Vec2& from, const Vec2& to) const {
  if (outer_.along(from, to)) return true;
  if (!inner_.along(from, to)) return false;
  return footprint_.is_clear_driving(map_, in_map(from, heading_between(from, to)),
                                     in_map(to, 0.0).position_m);
}

bool FootprintCollisionChecker::turning(const Vec2& at, double from_rad, double to_rad) const {
  if (outer_.along(at, at)) return true;
  if (!inner_.along(at, at)) return false;
  return footprint_.is_clear_turning(map_, in_map(at, from_rad), in_map(at, to_rad).yaw_rad);
}

bool FootprintCollisionChecker::along(std::span<const Vec2> points, const EndHeadings& headings) const {
  std::optional<double> heading_rad = headings.start_rad;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i] == points[i - 1]) continue;
    const double next_rad = heading_between(points[i - 1], points[i]);
    if (heading_rad && !turning(points[i - 1], *heading_rad, next_rad)) return false;
    if (!driving(points[i - 1], points[i])) return false;
    heading_rad = next_rad;
  }
  if (!heading_rad) heading_rad = headings.goal_rad;
  return !heading_rad || turning(points.back(), *heading_rad, headings.goal_rad.value_or(*heading_rad));
}

/// Rechecks what removing a point changes: the leg past it, and the turns before and after that leg.
std::vector<Vec2> FootprintCollisionChecker::with_fewer_legs(std::vector<Vec2> points,
                                                             const EndHeadings& headings) const {
  if (points.size() < 3) return points;
  points = leg_ends(points);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 1; i + 1 < points.size();) {
      const std::size_t first = i >= 2 ? i - 2 : 0;
      const std::size_t last = std::min(i + 2, points.size() - 1);
      std::vector<Vec2> around(points.begin() + static_cast<std::ptrdiff_t>(first),
                               points.begin() + static_cast<std::ptrdiff_t>(last) + 1);
      around.erase(around.begin() + static_cast<std::ptrdiff_t>(i - first));
      EndHeadings ends;
      if (first == 0) ends.start_rad = headings.start_rad;
      if (last + 1 == points.size()) ends.goal_rad = headings.goal_rad;
      if (along(around, ends)) {
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
      } else {
        ++i;
      }
    }
  }
  return points;
}

}  // namespace lodestar
