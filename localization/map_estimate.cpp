#include "localization/map_estimate.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace lodestar {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vec6& step) {
  Eigen::Isometry3d result = pose;
  result.translation() += step.head<3>();
  const Vec3 rotation = step.tail<3>();
  const double angle = rotation.norm();
  if (angle > 0.0)
    result.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() * pose.linear();
  return result;
}

/// The normal equations of the posterior at one pose.
struct Normal {
  Mat6 information = Mat6::Zero();
  Vec6 gradient = Vec6::Zero();  ///< of half the cost
  double cost = 0.0;
};

/// Huber: quadratic up to `scale` sigmas, linear beyond. Returns the weight of the quadratic form.
double add_huber_cost(double squared_sigmas, double scale, double& cost) {
  if (squared_sigmas <= scale * scale) {
    cost += squared_sigmas;
    return 1.0;
  }
  const double sigmas = std::sqrt(squared_sigmas);
  cost += scale * (2.0 * sigmas - scale);
  return scale / sigmas;
}

bool add_dots(const Eigen::Isometry3d& pose, const std::vector<SurveyedDot>& dots, const CameraModel& camera,
              const PoseFixOptions& options, Normal& normal) {
  const double per_variance = 1.0 / (options.dot_sigma_px * options.dot_sigma_px);
  for (const SurveyedDot& dot : dots) {
    const std::optional<Projection> seen = project_dot(pose, dot.point_in_map, camera);
    if (!seen) return false;
    const Vec2 residual = seen->pixel - dot.center_px;
    const double weight = per_variance * add_huber_cost(residual.squaredNorm() * per_variance,
                                                        options.robust_scale, normal.cost);
    normal.information.noalias() += weight * seen->jacobian.transpose() * seen->jacobian;
    normal.gradient.noalias() += weight * seen->jacobian.transpose() * residual;
  }
  return true;
}

/// The camera's axis, brought back by the mount's tilt, should stand upright: its two horizontal parts are
/// the tilt.
void add_tilt_prior(const Eigen::Isometry3d& pose, const PosePrior& prior, Normal& normal) {
  if (!prior.tilt_sigma_rad || *prior.tilt_sigma_rad == 0.0) return;
  const double per_variance = 1.0 / (*prior.tilt_sigma_rad * *prior.tilt_sigma_rad);
  const Vec3 up = pose.linear() * prior.tilt.transpose().col(2);
  Eigen::Matrix<double, 2, 6> jacobian = Eigen::Matrix<double, 2, 6>::Zero();
  jacobian.row(0).tail<3>() << 0.0, up.z(), -up.y();
  jacobian.row(1).tail<3>() << -up.z(), 0.0, up.x();
  normal.information.noalias() += per_variance * jacobian.transpose() * jacobian;
  normal.gradient.noalias() += per_variance * jacobian.transpose() * up.head<2>();
  normal.cost += per_variance * up.head<2>().squaredNorm();
}

void add_height_prior(const Eigen::Isometry3d& pose, const PosePrior& prior, Normal& normal) {
  if (!prior.height_m) return;
  const double per_variance = 1.0 / (prior.height_sigma_m * prior.height_sigma_m);
  const double error_m = pose.translation().z() - *prior.height_m;
  normal.information(2, 2) += per_variance;
  normal.gradient[2] += per_variance * error_m;
  normal.cost += per_variance * error_m * error_m;
}

bool tilt_is_exact(const PosePrior& prior) {
  return prior.tilt_sigma_rad && *prior.tilt_sigma_rad == 0.0;
}

/// An exact tilt leaves no freedom about the horizontal axes: those rows say "no step" and nothing else.
void forbid_tilting(Normal& normal) {
  for (const Eigen::Index axis : {3, 4}) {
    normal.information.row(axis).setZero();
    normal.information.col(axis).setZero();
    normal.information(axis, axis) = 1.0;
    normal.gradient[axis] = 0.0;
  }
}

std::optional<Normal> normal_at(const Eigen::Isometry3d& pose, const std::vector<SurveyedDot>& dots,
                                const CameraModel& camera, const PoseFixOptions& options) {
  Normal normal;
  if (!add_dots(pose, dots, camera, options, normal)) return std::nullopt;
  add_tilt_prior(pose, options.prior, normal);
  add_height_prior(pose, options.prior, normal);
  if (tilt_is_exact(options.prior)) forbid_tilting(normal);
  return normal;
}

/// The pose with the same place and heading, but with the tilt that the prior says.
Eigen::Isometry3d with_prior_tilt(const Eigen::Isometry3d& pose, const PosePrior& prior) {
  const Eigen::Matrix3d untilted = pose.linear() * prior.tilt.transpose();
  const double yaw = std::atan2(untilted(1, 0) - untilted(0, 1), untilted(0, 0) + untilted(1, 1));
  Eigen::Isometry3d result = pose;
  result.linear() = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix() * prior.tilt;
  return result;
}

/// The inverse of the information, zero where the tilt is exact.
std::optional<Mat6> covariance_of(const Normal& normal, bool exact_tilt) {
  // Metres and radians are of one size here, so that the factorization needs no scaling.
  const Eigen::LDLT<Mat6> factors(normal.information);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return std::nullopt;
  Mat6 covariance = factors.solve(Mat6::Identity());
  if (!covariance.allFinite() || !(covariance.diagonal().array() > 0.0).all()) return std::nullopt;
  if (exact_tilt) {
    covariance.middleRows<2>(3).setZero();
    covariance.middleCols<2>(3).setZero();
  }
  return Mat6(0.5 * (covariance + covariance.transpose()));
}

}  // namespace

std::optional<Projection> project_dot(const Eigen::Isometry3d& map_from_camera, const Vec3& point_in_map,
                                      const CameraModel& camera) {
  const Eigen::Matrix3d camera_from_map = map_from_camera.linear().transpose();
  const Vec3 offset = point_in_map - map_from_camera.translation();
  const Vec3 p = camera_from_map * offset;
  if (!(p.z() > 1e-6)) return std::nullopt;
  const Vec2 normalized = p.head<2>() / p.z();

  Eigen::Matrix<double, 2, 3> normalized_by_point;
  normalized_by_point << 1.0 / p.z(), 0.0, -normalized.x() / p.z(), 0.0, 1.0 / p.z(), -normalized.y() / p.z();
  const Eigen::Matrix<double, 2, 3> pixel_by_map =
      camera.distorted_jacobian(normalized) * normalized_by_point * camera_from_map;
  Projection projection;
  projection.pixel = camera.distorted(normalized);
  projection.jacobian.leftCols<3>() = -pixel_by_map;
  projection.jacobian.rightCols<3>().noalias() = pixel_by_map * cross_matrix(offset);
  return projection;
}

std::optional<MapEstimate> maximize_posterior(const Eigen::Isometry3d& guess,
                                              const std::vector<SurveyedDot>& dots, const CameraModel& camera,
                                              const PoseFixOptions& options) {
  const bool exact_tilt = tilt_is_exact(options.prior);
  Eigen::Isometry3d pose = exact_tilt ? with_prior_tilt(guess, options.prior) : guess;
  std::optional<Normal> normal = normal_at(pose, dots, camera, options);
  if (!normal) return std::nullopt;

  double damping = 1e-6;
  constexpr int max_iterations = 40;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Mat6 damped = normal->information;
    damped.diagonal() *= 1.0 + damping;
    const Vec6 step = -damped.ldlt().solve(normal->gradient);
    if (!step.allFinite()) return std::nullopt;
    const Eigen::Isometry3d candidate = moved(pose, step);
    const std::optional<Normal> next = normal_at(candidate, dots, camera, options);
    if (next && next->cost <= normal->cost) {
      const double gain = normal->cost - next->cost;
      pose = candidate;
      normal = next;
      damping = std::max(0.1 * damping, 1e-12);
      if (gain < 1e-9 * (1.0 + normal->cost)) break;
    } else {
      damping *= 10.0;
      if (damping > 1e6) break;
    }
  }
  const std::optional<Mat6> covariance = covariance_of(*normal, exact_tilt);
  if (!covariance) return std::nullopt;
  return MapEstimate{.map_from_camera = pose, .covariance = *covariance, .cost = normal->cost};
}

}  // namespace lodestar
