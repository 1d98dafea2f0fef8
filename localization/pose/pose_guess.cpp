#include "localization/pose/pose_guess.hpp"

#include <cmath>

namespace lodestar {
namespace {

/// Eq. (12) and (13).
std::optional<Vec3> ray_through(const Vec2& pixel, const CameraModel& camera) {
  const std::optional<Vec2> normalized = camera.normalized(pixel);
  if (!normalized) return std::nullopt;
  return Vec3(normalized->x(), normalized->y(), 1.0).normalized();
}

/// Intersection of the ray with the plane at unit height above the camera, after removing its tilt.
std::optional<Vec2> level_ray(const Vec2& pixel, const CameraModel& camera, const Eigen::Matrix3d& tilt) {
  const std::optional<Vec2> normalized = camera.normalized(pixel);
  if (!normalized) return std::nullopt;
  const Vec3 level = tilt * normalized->homogeneous();
  if (!(level.z() > 0.0)) return std::nullopt;
  return Vec2(level.head<2>() / level.z());
}

}  // namespace

P3pSolutions p3p_guesses(const std::array<SurveyedDot, 3>& direction_dots, const CameraModel& camera) {
  std::array<Vec3, 3> rays;
  std::array<Vec3, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<Vec3> ray = ray_through(direction_dots[k].center_px, camera);
    if (!ray) return {};
    rays[k] = *ray;
    points[k] = direction_dots[k].point_in_map;
  }
  return solve_p3p(rays, points);
}

std::optional<Eigen::Isometry3d> level_guess(std::span<const SurveyedDot> dots, const CameraModel& camera,
                                             const PosePrior& prior) {
  // Sums of products of rays and points as complex numbers, relative to the first of each, then to the means.
  const std::optional<Vec2> first_ray = level_ray(dots.front().center_px, camera, prior.tilt);
  if (!first_ray) return std::nullopt;
  const Vec3& first_point = dots.front().point_in_map;
  Vec2 ray_sum = Vec2::Zero();
  Vec3 point_sum = Vec3::Zero();
  double along = 0.0;
  double across = 0.0;
  double spread = 0.0;
  for (const SurveyedDot& dot : dots) {
    const std::optional<Vec2> level = level_ray(dot.center_px, camera, prior.tilt);
    if (!level) return std::nullopt;
    const Vec2 ray = *level - *first_ray;
    const Vec3 point = dot.point_in_map - first_point;
    ray_sum += ray;
    point_sum += point;
    along += ray.dot(point.head<2>());
    across += cross(ray, point.head<2>());
    spread += ray.squaredNorm();
  }
  const double per_dot = 1.0 / static_cast<double>(dots.size());
  along -= per_dot * ray_sum.dot(point_sum.head<2>());
  across -= per_dot * cross(ray_sum, point_sum.head<2>());
  spread -= per_dot * ray_sum.squaredNorm();
  const double distance_m = Vec2(along, across).norm() / spread;
  if (!std::isfinite(distance_m) || distance_m <= 0.0) return std::nullopt;

  const Vec2 mean_ray = *first_ray + per_dot * ray_sum;
  const Vec3 mean_point = first_point + per_dot * point_sum;
  const Vec2 direction = Vec2(along, across).normalized();
  Eigen::Matrix3d heading;
  heading << direction.x(), -direction.y(), 0.0, direction.y(), direction.x(), 0.0, 0.0, 0.0, 1.0;
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  guess.linear() = heading * prior.tilt;
  guess.translation() = mean_point - heading * Vec3(mean_ray.x(), mean_ray.y(), 1.0) * distance_m;
  return guess;
}

Eigen::Isometry3d mirrored(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots) {
  Vec3 center = Vec3::Zero();
  for (const SurveyedDot& dot : dots) center += dot.point_in_map / static_cast<double>(dots.size());
  const Vec3 center_in_camera = map_from_camera.inverse() * center;
  const Vec3 sight = center_in_camera.normalized();
  const Eigen::Matrix3d swap_depths = Eigen::Matrix3d::Identity() - 2.0 * sight * sight.transpose();
  Eigen::Isometry3d other = Eigen::Isometry3d::Identity();
  other.linear() = Vec3(1.0, 1.0, -1.0).asDiagonal() * map_from_camera.linear() * swap_depths;
  other.translation() = center - other.linear() * center_in_camera;
  return other;
}

}  // namespace lodestar
