#include "drivers/simulation/projected_disc.hpp"

#include <array>
#include <cmath>

namespace lodestar {
namespace {

constexpr int corners = 12;  // of the polygon that approximates the outline

/// Area, centroid and second moments about the centroid of a polygon.
struct Moments {
  double area = 0.0;
  Vec2 centroid = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
};

Moments moments_of(const std::array<Vec2, corners>& polygon) {
  // Relative to the first corner, to limit cancellation far from the image origin.
  double twice_area = 0.0;
  Vec2 first = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - polygon[0];
    const Vec2 b = polygon[i + 1] - polygon[0];
    const double twice_triangle = cross(a, b);
    const Vec2 sum = a + b;
    twice_area += twice_triangle;
    first += twice_triangle * sum;
    second += twice_triangle * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  }
  const double area = 0.5 * twice_area;
  const Vec2 centroid = first / (6.0 * area);
  return {area, polygon[0] + centroid, second / 24.0 - area * centroid * centroid.transpose()};
}

}  // namespace

std::optional<ProjectedDisc> project_disc(const Vec3& center_in_map, double radius_m,
                                          const Eigen::Isometry3d& camera_from_map,
                                          const CameraModel& camera) {
  std::array<Vec2, corners> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const Vec3 rim = center_in_map + radius_m * Vec3(std::cos(angle), std::sin(angle), 0.0);
    const std::optional<Vec2> pixel = camera.project(camera_from_map * rim);
    if (!pixel) return std::nullopt;
    outline[static_cast<std::size_t>(i)] = *pixel;
  }
  const Moments moments = moments_of(outline);
  // For an ellipse with semi-axes S the second moments are area * S S^T / 4; those of an inscribed regular
  // polygon are smaller by a known factor.
  static const double polygon_share = (2.0 + std::cos(2.0 * std::numbers::pi / corners)) / 3.0;
  const Eigen::Matrix2d squared = moments.second * (4.0 / (moments.area * polygon_share));
  const double determinant = squared.determinant();
  if (!(determinant > 1e-12)) return std::nullopt;
  const Eigen::Matrix2d px_from_unit = squared.llt().matrixL();
  return ProjectedDisc{moments.centroid, px_from_unit.inverse(), std::sqrt(std::sqrt(determinant)),
                       squared.diagonal().cwiseSqrt()};
}

}  // namespace lodestar
