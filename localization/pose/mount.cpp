#include "localization/pose/mount.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace lodestar {
namespace {

/// Jacobian of the base's position and heading by the camera's pose (translation, rotation about the map's
/// axes): a lever connects base and camera, and the heading is the horizontal direction of the base's x axis.
Eigen::Matrix<double, 3, 6> base_by_camera(const Eigen::Isometry3d& map_from_camera,
                                           const Eigen::Isometry3d& map_from_base) {
  const Vec3 lever = map_from_base.translation() - map_from_camera.translation();
  const Vec3 ahead = map_from_base.linear().col(0);
  const double level = ahead.head<2>().squaredNorm();
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
  jacobian.leftCols<2>().topRows<2>().setIdentity();
  jacobian.row(0).tail<3>() << 0.0, lever.z(), -lever.y();
  jacobian.row(1).tail<3>() << -lever.z(), 0.0, lever.x();
  jacobian.row(2).tail<3>() << -ahead.x() * ahead.z() / level, -ahead.y() * ahead.z() / level, 1.0;
  return jacobian;
}

/// Kasa's algebraic fit: |p|^2 = 2 c.p + (r^2 - |c|^2) is linear in the centre and the bracket.
std::optional<Circle> algebraic_circle(const std::vector<Vec2>& points, const Vec2& mean) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (const Vec2& point : points) {
    const Vec2 p = point - mean;
    const Vec3 row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    normal += row * row.transpose();
    right += row * p.squaredNorm();
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> factors(normal);
  if (!factors.isInvertible()) return std::nullopt;
  const Vec3 solution = factors.solve(right);
  const double squared_radius = solution.z() + solution.head<2>().squaredNorm();
  if (!(squared_radius > 0.0)) return std::nullopt;
  return Circle{mean + solution.head<2>(), std::sqrt(squared_radius)};
}

}  // namespace

PlanarFix compensate_mount(const PoseFix& fix, const Eigen::Isometry3d& base_from_camera) {
  const Eigen::Isometry3d map_from_base = fix.map_from_camera * base_from_camera.inverse();
  const Eigen::Matrix<double, 3, 6> jacobian = base_by_camera(fix.map_from_camera, map_from_base);
  PlanarFix planar{.stamp = fix.stamp,
                   .map_from_base = flattened(map_from_base),
                   .covariance = jacobian * fix.covariance * jacobian.transpose(),
                   .shared_covariance = jacobian * fix.shared_covariance * jacobian.transpose(),
                   .by_offsets = {},
                   .ids = fix.ids};
  for (const PoseByOffset& by_offset : fix.by_offsets)
    planar.by_offsets.push_back({by_offset.id, jacobian * by_offset.jacobian});
  return planar;
}

std::optional<Circle> fit_circle(const std::vector<Vec2>& points) {
  if (points.size() < 3) return std::nullopt;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& point : points) mean += point / static_cast<double>(points.size());
  std::optional<Circle> circle = algebraic_circle(points, mean);
  // The algebraic fit is biased towards small circles under noise; Gauss-Newton on the distances corrects it.
  for (int iteration = 0; circle && iteration < 20; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (const Vec2& point : points) {
      const Vec2 out = point - circle->center_m;
      const double distance = out.norm();
      if (distance == 0.0) return std::nullopt;
      const Vec3 row(-out.x() / distance, -out.y() / distance, -1.0);
      normal += row * row.transpose();
      right += row * (distance - circle->radius_m);
    }
    const Vec3 step = -normal.ldlt().solve(right);
    if (!step.allFinite()) return std::nullopt;
    circle->center_m += step.head<2>();
    circle->radius_m += step.z();
    if (step.norm() < 1e-12) break;
  }
  return circle;
}

}  // namespace lodestar
