#pragma once

#include <vector>

#include "maps/geometry.hpp"
#include "maps/scan.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// One beam, placed where the robot was when it was measured.
struct Ray {
  Stamp stamp;
  Vec2 origin_m = Vec2::Zero();  ///< of the scanner
  /// What was hit; for `nothing` the end of the scanner's range, for `too_near` the end of its blind zone,
  /// for `invalid` a point 1 m away that only tells the direction.
  Vec2 end_m = Vec2::Zero();
  Echo echo = Echo::invalid;
};

/// Is there something at the ray's end?
inline bool ends_at_something(const Ray& ray) {
  return ray.echo == Echo::hit || ray.echo == Echo::too_near;
}

/// The leg of a chair. Between two rays that pass closer together than this, one that was lost has met
/// nothing.
inline constexpr double thin_thing_m = 0.02;

/// How far its end is from the scanner, at something or not.
inline double range_m(const Ray& ray) {
  return (ray.end_m - ray.origin_m).norm();
}

/// A scan freed of the robot's motion during the turn: all rays in one frame that does not move with the
/// robot, the odometry frame. In the order in which they were measured; beams that hit the robot itself are
/// left out.
struct DeskewedScan {
  Stamp newest;  ///< of the beam measured last
  std::vector<Ray> rays;
};

}  // namespace lodestar
