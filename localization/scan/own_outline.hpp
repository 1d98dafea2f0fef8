#pragma once

#include "maps/robot_shape.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// What the scanner is mounted on, as far as it sees it.
struct OwnOutline {
  RobotShape shape;
  /// Hits this near to the outline, or inside it, may be the robot itself: 2 standard deviations of the range
  /// of a cheap scanner (1.5 cm).
  double margin_m = 0.03;

  [[nodiscard]] bool holds(const Vec2& point_in_base) const {
    return shape.distance_m(point_in_base) < margin_m;
  }
};

/// Where a beam ends, in the base frame; one that brought nothing back at the end of what it could have seen,
/// an invalid one 1 m away.
Vec2 end_in_base(const Beam& beam, const Scan& scan, const ScannerMount& mount);

}  // namespace lodestar
