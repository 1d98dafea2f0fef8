#pragma once

#include <vector>

#include "maps/footprint.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// The robot's outline in the base frame, seen by a point beside it: a disc about the base frame's origin, or
/// a footprint.
class RobotShape {
 public:
  explicit RobotShape(double radius_m);
  explicit RobotShape(const Footprint& footprint);

  /// From the outline to a point of the base frame; negative inside.
  [[nodiscard]] double distance_m(const Vec2& point_in_base) const;

  /// Of the smallest disc about the origin that holds the robot.
  [[nodiscard]] double outer_radius_m() const { return outer_radius_m_; }

  /// A disc that turns on the spot leaves its outline where it is.
  [[nodiscard]] bool is_disc() const { return corners_m_.empty(); }

 private:
  std::vector<Vec2> corners_m_;  ///< none: a disc
  double outer_radius_m_ = 0.0;
};

}  // namespace lodestar
