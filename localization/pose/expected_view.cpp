#include "localization/pose/expected_view.hpp"

#include <cmath>

namespace lodestar {
namespace {

/// Jacobian of the camera's pose by the base's: the lever from base to camera rotates with the base.
Eigen::Matrix<double, 6, 3> camera_by_base(const Eigen::Isometry3d& map_from_base,
                                           const Eigen::Isometry3d& map_from_camera) {
  const Vec3 lever = map_from_camera.translation() - map_from_base.translation();
  Eigen::Matrix<double, 6, 3> jacobian = Eigen::Matrix<double, 6, 3>::Zero();
  jacobian(0, 0) = jacobian(1, 1) = jacobian(5, 2) = 1.0;
  jacobian(0, 2) = -lever.y();
  jacobian(1, 2) = lever.x();
  return jacobian;
}

}  // namespace

std::optional<ExpectedView> expected_view(const PoseEstimate& robot,
                                          const Eigen::Isometry3d& base_from_camera, const PosePrior& prior) {
  if (!prior.tilt_sigma_rad) return std::nullopt;
  const Eigen::Isometry3d map_from_base = lifted(robot.map_from_base);
  ExpectedView view;
  view.map_from_camera = map_from_base * base_from_camera;
  const Eigen::Matrix<double, 6, 3> jacobian = camera_by_base(map_from_base, view.map_from_camera);
  view.covariance = jacobian * robot.covariance * jacobian.transpose();
  view.covariance(2, 2) += square(prior.height_sigma_m);
  view.covariance(3, 3) += square(*prior.tilt_sigma_rad);
  view.covariance(4, 4) += square(*prior.tilt_sigma_rad);
  return view;
}

ExpectedView expected_view(const PoseFix& last, Duration since, const CameraMotionLimits& limits) {
  ExpectedView view{.map_from_camera = last.map_from_camera, .covariance = last.covariance};
  const double elapsed_s = std::abs(seconds(since));
  view.covariance.diagonal().head<3>().array() += square(0.5 * limits.speed_mps * elapsed_s);
  view.covariance.diagonal().tail<3>().array() += square(0.5 * limits.turn_radps * elapsed_s);
  return view;
}

}  // namespace lodestar
