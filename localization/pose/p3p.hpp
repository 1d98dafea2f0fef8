#pragma once

#include <array>
#include <cstddef>

#include "maps/geometry.hpp"

namespace lodestar {

/// Up to four poses; range-for goes over those that there are.
struct P3pSolutions {
  std::array<Eigen::Isometry3d, 4> camera_from_points;
  std::size_t count = 0;

  [[nodiscard]] const Eigen::Isometry3d* begin() const { return camera_from_points.data(); }
  [[nodiscard]] const Eigen::Isometry3d* end() const { return begin() + count; }
};

/// The perspective-three-point problem, Eq. (10)-(15): unit rays in the camera frame towards three points,
/// whose places are known in another frame. The depths are found as the common points of two conics, one of
/// whose pencil falls apart into two lines (Persson and Nordberg 2018), and polished by Newton's method on
/// Eq. (10). None for points on a line.
P3pSolutions solve_p3p(const std::array<Vec3, 3>& rays, const std::array<Vec3, 3>& points);

}  // namespace lodestar
