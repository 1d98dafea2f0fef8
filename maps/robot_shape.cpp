#include "maps/robot_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {

RobotShape::RobotShape(double radius_m) : outer_radius_m_(radius_m) {}

RobotShape::RobotShape(const Footprint& footprint)
    : corners_m_(footprint.corners_m()), outer_radius_m_(footprint.outer_radius_m()) {}

double RobotShape::distance_m(const Vec2& point_in_base) const {
  if (is_disc()) return point_in_base.norm() - outer_radius_m_;
  double squared_m2 = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  Vec2 a = corners_m_.back() - point_in_base;
  for (const Vec2& corner : corners_m_) {
    const Vec2 b = corner - point_in_base;
    const Vec2 edge = b - a;
    const double along = std::clamp(-a.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    squared_m2 = std::min(squared_m2, (a + along * edge).squaredNorm());
    // A ray from the point along x crosses the outline an odd number of times when it begins inside.
    if ((a.y() > 0.0) != (b.y() > 0.0) && a.x() - a.y() * edge.x() / edge.y() > 0.0) is_inside = !is_inside;
    a = b;
  }
  return is_inside ? -std::sqrt(squared_m2) : std::sqrt(squared_m2);
}

}  // namespace lodestar
