#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

// Points, angles and transforms. A transform's name gives its target and its source frame, so that in a
// product the inner names match: point_in_map = map_from_base * base_from_camera * point_in_camera.
namespace lodestar {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

inline constexpr double mm_per_m = 1000.0;

constexpr double radians(double deg) {
  return deg * (std::numbers::pi / 180.0);
}
constexpr double degrees(double rad) {
  return rad * (180.0 / std::numbers::pi);
}

constexpr double square(double x) {
  return x * x;
}

/// The third component of the cross product: positive when `b` points to the left of `a`.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The equivalent angle in (-pi, pi].
double wrap_angle(double angle_rad);

/// The heading of a vector in the plane, in (-pi, pi]: 0 along x, counter-clockwise.
double heading_of(const Vec2& way);

/// The heading of the way from one point to another, Eq. (18) with atan2.
double heading_between(const Vec2& from, const Vec2& to);

/// A rigid transform in the plane, or the pose of one frame in another: x and y in metres, yaw
/// counter-clockwise.
struct Pose2 {
  Vec2 position_m = Vec2::Zero();
  double yaw_rad = 0.0;
};

/// Composition; the yaw of the result is wrapped.
Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);
Vec2 operator*(const Pose2& a_from_b, const Vec2& point_in_b);
Pose2 inverse(const Pose2& a_from_b);

/// The same transform in 3D, at height z_m.
Eigen::Isometry3d lifted(const Pose2& pose, double z_m = 0.0);

/// Projection of a 3D pose into the plane: drops height, roll and pitch. Yaw is the direction of the
/// projected x axis.
Pose2 flattened(const Eigen::Isometry3d& pose);

/// Rotation Rz(yaw) Ry(pitch) Rx(roll), and its inverse. Angles in radians.
struct RollPitchYaw {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};
Eigen::Matrix3d rotation_from(const RollPitchYaw& angles);
RollPitchYaw angles_of(const Eigen::Matrix3d& rotation);

/// Standard deviation along the longer axis of a covariance's ellipse.
double larger_sigma(const Eigen::Matrix2d& covariance);

}  // namespace lodestar
