#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "maps/camera_model.hpp"
#include "maps/marker.hpp"

// The image of a dot, in the camera's axes. Inline: this is where most of a fix's time goes.
namespace lodestar {

/// Image of a dot and its derivatives, in which most of the terms are zero: by_u and by_v are those of u and
/// v by (position, rotation) of the camera along and about its own axes.
struct ProjectionInCamera {
  Vec2 pixel;
  Eigen::Matrix<double, 6, 1> by_u;
  Eigen::Matrix<double, 6, 1> by_v;
};

/// Centroid of a horizontal disc's image minus the image of its centre, as rays at unit depth. With the
/// disc's points q(s, t) seen at depth z(s, t), s and t along the map's axes, the centroid is off by r^2 / 4
/// (laplacian(q) / 2 + grad(q) . grad(ln J)), with J, the change of area, proportional to z^-3. Both terms
/// are multiples of grad(z) . grad(q) / z: -1 and -3.
inline Vec2 disc_offset(const Vec2& normalized, double depth_m, const Eigen::Matrix3d& map_from_camera) {
  Vec2 sum = Vec2::Zero();
  for (const Eigen::Index axis : {0, 1}) {
    const double depth_change = map_from_camera(axis, 2);
    sum += depth_change * (map_from_camera.row(axis).head<2>().transpose() - depth_change * normalized);
  }
  return -square(marker_dot_radius_m / depth_m) * sum;
}

/// Nothing behind the camera.
inline std::optional<ProjectionInCamera> project_in_camera(const Eigen::Isometry3d& map_from_camera,
                                                           const Vec3& point_in_map,
                                                           const CameraModel& camera) {
  const Vec3 offset = point_in_map - map_from_camera.translation();
  const Vec3 p = map_from_camera.linear().transpose() * offset;
  if (!(p.z() > 1e-6)) return std::nullopt;
  const double per_depth = 1.0 / p.z();
  const Vec2 normalized = per_depth * p.head<2>();
  const Eigen::Matrix2d by_normalized = camera.distorted_jacobian(normalized);
  ProjectionInCamera projection;
  projection.pixel =
      camera.distorted(normalized) + by_normalized * disc_offset(normalized, p.z(), map_from_camera.linear());
  const auto fill = [&](Eigen::Index row, Eigen::Matrix<double, 6, 1>& derivative) {
    const double by_x = per_depth * by_normalized(row, 0);
    const double by_y = per_depth * by_normalized(row, 1);
    const Vec3 by_point(by_x, by_y, -(by_x * normalized.x() + by_y * normalized.y()));
    derivative << -by_point, by_point.cross(p);
  };
  fill(0, projection.by_u);
  fill(1, projection.by_v);
  return projection;
}

}  // namespace lodestar
