#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

// The words for place and direction. A transform's name says where it goes and where it comes from, so that
// in a product the inner words meet: point_in_map = map_from_base * base_from_camera * point_in_camera.
namespace lodestar {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

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

/// The same direction in (-pi, pi].
double wrap_angle(double angle_rad);

/// The heading of a vector in the plane, in (-pi, pi]: 0 along x, counter-clockwise.
double heading_of(const Vec2& way);

/// The heading of the way from one point to another, Eq. (18) with atan2.
double heading_between(const Vec2& from, const Vec2& to);

/// A rigid motion of the plane, or the place of one frame in another: x and y in metres, yaw
/// counter-clockwise.
struct Pose2 {
  Vec2 position_m = Vec2::Zero();
  double yaw_rad = 0.0;
};

/// Composition; the yaw of the result is wrapped.
Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);
Vec2 operator*(const Pose2& a_from_b, const Vec2& point_in_b);
Pose2 inverse(const Pose2& a_from_b);

/// The same motion in space, at height z_m.
Eigen::Isometry3d lifted(const Pose2& pose, double z_m = 0.0);

/// The pose seen from above: drops height, roll and pitch. Yaw is the direction of the x axis in the plane.
Pose2 flattened(const Eigen::Isometry3d& pose);

/// Rotation Rz(yaw) Ry(pitch) Rx(roll), and its inverse. Angles in radians.
struct RollPitchYaw {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};
Eigen::Matrix3d rotation_from(const RollPitchYaw& angles);
RollPitchYaw angles_of(const Eigen::Matrix3d& rotation);

}  // namespace lodestar
