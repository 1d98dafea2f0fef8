#include "maps/robot_shape.hpp"

#include "maps/segment.hpp"

namespace lodestar {

RobotShape::RobotShape(double radius_m) : outer_radius_m_(radius_m) {}

RobotShape::RobotShape(const Footprint& footprint)
    : corners_m_(footprint.corners_m()), outer_radius_m_(footprint.outer_radius_m()) {}

double RobotShape::distance_m(const Vec2& point_in_base) const {
  if (is_disc()) return point_in_base.norm() - outer_radius_m_;
  return distance_to_outline(corners_m_, point_in_base);
}

}  // namespace lodestar
