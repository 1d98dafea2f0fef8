#pragma once

#include <array>
#include <cstddef>

#include "maps/geometry.hpp"

namespace lodestar {

/// Up to four poses; a range-for visits those found.
struct P3pSolutions {
  std::array<Eigen::Isometry3d, 4> camera_from_points;
  std::size_t count = 0;

  [[nodiscard]] const Eigen::Isometry3d* begin() const { return camera_from_points.data(); }
  [[nodiscard]] const Eigen::Isometry3d* end() const { return begin() + count; }
};

/// Perspective-three-point problem, Eq. (10)-(15): unit rays in the camera frame towards three points whose
/// positions are known in another frame. The depths are the common points of two conics, found from a
/// degenerate conic of their pencil, which splits into two lines (Persson and Nordberg 2018), and refined by
/// Newton's method on Eq. (10). No solution for collinear points.
P3pSolutions solve_p3p(const std::array<Vec3, 3>& rays, const std::array<Vec3, 3>& points);

}  // namespace lodestar
