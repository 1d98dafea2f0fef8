#include "localization/arc_covariance.hpp"

#include <array>

namespace lodestar {

Eigen::Matrix3d arc_covariance(const Vec3& center_from_camera, const Eigen::Matrix3d& rotation_covariance) {
  std::array<Eigen::Matrix3d, 3> form_times_covariance;
  for (Eigen::Index k = 0; k < 3; ++k) {
    Eigen::Matrix3d form = center_from_camera[k] * Eigen::Matrix3d::Identity();
    form.row(k) -= 0.5 * center_from_camera.transpose();
    form.col(k) -= 0.5 * center_from_camera;
    form_times_covariance[static_cast<std::size_t>(k)] = form * rotation_covariance;
  }
  Eigen::Matrix3d result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Eigen::Matrix3d& a = form_times_covariance[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d& b = form_times_covariance[static_cast<std::size_t>(j)];
      result(i, j) = 0.25 * (a.trace() * b.trace() + 2.0 * a.cwiseProduct(b.transpose()).sum());
    }
  }
  return result;
}

}  // namespace lodestar
