#include "localization/pose/second_order_covariance.hpp"

#include <array>

namespace lodestar {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Symmetric matrix of the k-th coordinate of theta x p + theta x (theta x u) / 2 in (p, theta).
Mat6 form_of(Eigen::Index k, const Vec3& u) {
  Mat6 form = Mat6::Zero();
  const Eigen::Index next = (k + 1) % 3;
  const Eigen::Index after = (k + 2) % 3;
  form(3 + next, after) = form(after, 3 + next) = 0.5;
  form(3 + after, next) = form(next, 3 + after) = -0.5;
  auto of_turns = form.bottomRightCorner<3, 3>();
  of_turns.diagonal().setConstant(-0.5 * u[k]);
  of_turns.row(k) += 0.25 * u.transpose();
  of_turns.col(k) += 0.25 * u;
  return form;
}

}  // namespace

Eigen::Matrix3d arc_covariance(const Vec3& center_from_camera, const Mat6& covariance) {
  std::array<Mat6, 3> form_times_covariance;
  for (Eigen::Index k = 0; k < 3; ++k)
    form_times_covariance[static_cast<std::size_t>(k)] = form_of(k, center_from_camera) * covariance;
  Eigen::Matrix3d result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Mat6& a = form_times_covariance[static_cast<std::size_t>(i)];
      const Mat6& b = form_times_covariance[static_cast<std::size_t>(j)];
      result(i, j) = a.trace() * b.trace() + 2.0 * a.cwiseProduct(b.transpose()).sum();
    }
  }
  return result;
}

Eigen::Matrix3d scale_covariance(const Vec3& center_from_camera, const Vec3& optical_axis,
                                 double scale_sigma) {
  const double off_m = scale_sigma * optical_axis.dot(center_from_camera);
  return off_m * off_m * optical_axis * optical_axis.transpose();
}

}  // namespace lodestar
