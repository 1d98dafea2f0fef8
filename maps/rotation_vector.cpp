#include "maps/rotation_vector.hpp"

#include <cmath>

namespace lodestar {

Eigen::Matrix3d rotation_by(const Vec3& vector) {
  const double angle = vector.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix()
                     : Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d skew(const Vec3& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Matrix3d turn_by_vector(const Vec3& vector) {
  const double angle = vector.norm();
  const Eigen::Matrix3d cross = skew(vector);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * cross;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / (angle * angle) * cross +
         (angle - std::sin(angle)) / (angle * angle * angle) * cross * cross;
}

}  // namespace lodestar
