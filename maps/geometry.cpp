#include "maps/geometry.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lodestar {

double wrap_angle(double angle_rad) {
  if (std::abs(angle_rad) < std::numbers::pi) return angle_rad;  // as nearly all are
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

double heading_of(const Vec2& way) {
  return std::atan2(way.y(), way.x());
}

double heading_between(const Vec2& from, const Vec2& to) {
  return heading_of(to - from);
}

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  return {a_from_b * b_from_c.position_m, wrap_angle(a_from_b.yaw_rad + b_from_c.yaw_rad)};
}

Vec2 operator*(const Pose2& a_from_b, const Vec2& point_in_b) {
  return a_from_b.position_m + Eigen::Rotation2Dd(a_from_b.yaw_rad) * point_in_b;
}

Pose2 inverse(const Pose2& a_from_b) {
  return {Eigen::Rotation2Dd(-a_from_b.yaw_rad) * -a_from_b.position_m, wrap_angle(-a_from_b.yaw_rad)};
}

Eigen::Isometry3d lifted(const Pose2& pose, double z_m) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(pose.yaw_rad, Vec3::UnitZ()).toRotationMatrix();
  result.translation() << pose.position_m, z_m;
  return result;
}

Pose2 flattened(const Eigen::Isometry3d& pose) {
  return {pose.translation().head<2>(), std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

Eigen::Matrix3d rotation_from(const RollPitchYaw& angles) {
  return (Eigen::AngleAxisd(angles.yaw_rad, Vec3::UnitZ()) *
          Eigen::AngleAxisd(angles.pitch_rad, Vec3::UnitY()) *
          Eigen::AngleAxisd(angles.roll_rad, Vec3::UnitX()))
      .toRotationMatrix();
}

RollPitchYaw angles_of(const Eigen::Matrix3d& rotation) {
  return {std::atan2(rotation(2, 1), rotation(2, 2)),
          std::atan2(-rotation(2, 0), std::hypot(rotation(2, 1), rotation(2, 2))),
          std::atan2(rotation(1, 0), rotation(0, 0))};
}

double larger_sigma(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[1], 0.0));
}

}  // namespace lodestar
