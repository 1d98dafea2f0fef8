#include "localization/pose/map_estimate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/pose/dot_projection.hpp"
#include "localization/pose/huber.hpp"
#include "localization/pose/second_order_covariance.hpp"

namespace lodestar {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vec6& step) {
  Eigen::Isometry3d result = pose;
  result.translation() += step.head<3>();
  const Vec3 rotation = step.tail<3>();
  const double angle = rotation.norm();
  if (angle > 0.0)
    result.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() * pose.linear();
  return result;
}

/// The step from one pose to another: the inverse of moved().
Vec6 step_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  Vec6 step;
  step << to.translation() - from.translation(), turn.angle() * turn.axis();
  return step;
}

/// The normal equations of the posterior at one pose.
struct Normal {
  Mat6 information = Mat6::Zero();
  Mat6 information_of_dots = Mat6::Zero();  ///< without the prior's
  Mat6 shared_of_gradient = Mat6::Zero();   ///< the gradient's covariance by the offsets of all markers
  InlineVector<Mat65, most_offsets_of_fix> gradient_by_offsets;
  Vec6 gradient = Vec6::Zero();  ///< of half the cost
  double cost = 0.0;
  bool is_quadratic = true;  ///< no dot is in the linear range of its Huber loss
};

/// Rotates from the camera's axes to the map's.
void turn(Mat6& matrix, const Eigen::Matrix3d& map_from_camera) {
  for (const Eigen::Index i : {0, 3})
    for (const Eigen::Index j : {0, 3})
      matrix.block<3, 3>(i, j) = map_from_camera * matrix.block<3, 3>(i, j) * map_from_camera.transpose();
}

bool add_dots(const Eigen::Isometry3d& pose, std::span<const SurveyedDot> dots, const CameraModel& camera,
              const PoseFixOptions& options, Normal& normal) {
  for (const SurveyedDot& dot : dots) {
    const double per_variance = 1.0 / square(dot.sigma_px);
    const std::optional<ProjectionInCamera> seen = project_in_camera(pose, dot.point_in_map, camera);
    if (!seen) return false;
    const Vec2 residual = seen->pixel - dot.center_px;
    const Huber loss = huber(residual.squaredNorm() * per_variance, options.robust_scale);
    const double weight = loss.weight * per_variance;
    normal.cost += loss.cost;
    normal.is_quadratic = normal.is_quadratic && loss.weight == 1.0;
    normal.gradient += (weight * residual.x()) * seen->by_u + (weight * residual.y()) * seen->by_v;
    for (Eigen::Index k = 0; k < 6; ++k) {
      normal.information.col(k) +=
          (weight * seen->by_u[k]) * seen->by_u + (weight * seen->by_v[k]) * seen->by_v;
    }
  }
  return true;
}

bool add_marker(const Eigen::Isometry3d& pose, std::span<const SurveyedDot> dots, const DotsOfMarker& marker,
                const CameraModel& camera, const PoseFixOptions& options, Normal& normal) {
  const bool is_listed = normal.gradient_by_offsets.size() < most_offsets_of_fix;
  if (!marker.sigma) {
    if (is_listed) normal.gradient_by_offsets.emplace_back(Mat65::Zero());
    return add_dots(pose, dots, camera, options, normal);
  }
  const auto known =
      eliminate_offset(pose, dots, marker.origin_m, *marker.sigma, camera, options.robust_scale);
  if (!known) return false;
  normal.cost += known->cost;
  normal.is_quadratic = normal.is_quadratic && known->is_quadratic;
  normal.gradient += known->gradient;
  normal.information += known->information;
  normal.shared_of_gradient += known->gradient_by_offset * known->gradient_by_offset.transpose();
  if (is_listed) normal.gradient_by_offsets.push_back(known->gradient_by_offset);
  return true;
}

/// What a pose is estimated from.
struct Sight {
  std::span<const SurveyedDot> dots;
  std::span<const DotsOfMarker> markers;  ///< empty where all places are exact
  const CameraModel& camera;
  const PoseFixOptions& options;
};

bool add_sight(const Eigen::Isometry3d& pose, const Sight& sight, Normal& normal) {
  if (sight.markers.empty() && !add_dots(pose, sight.dots, sight.camera, sight.options, normal)) return false;
  std::size_t first = 0;
  for (const DotsOfMarker& marker : sight.markers) {
    const std::span<const SurveyedDot> dots = sight.dots.subspan(first, marker.count);
    if (!add_marker(pose, dots, marker, sight.camera, sight.options, normal)) return false;
    first += marker.count;
  }
  const Eigen::Matrix3d& map_from_camera = pose.linear();
  turn(normal.information, map_from_camera);
  if (!sight.markers.empty()) turn(normal.shared_of_gradient, map_from_camera);
  for (const Eigen::Index i : {0, 3}) {
    normal.gradient.segment<3>(i) = map_from_camera * normal.gradient.segment<3>(i);
    for (Mat65& by_offset : normal.gradient_by_offsets)
      by_offset.middleRows<3>(i) = map_from_camera * by_offset.middleRows<3>(i);
  }
  normal.information_of_dots = normal.information;
  return true;
}

bool tilt_is_exact(const PosePrior& prior) {
  return prior.tilt_sigma_rad && *prior.tilt_sigma_rad == 0.0;
}

bool tilt_is_known_about(const PosePrior& prior) {
  return prior.tilt_sigma_rad && *prior.tilt_sigma_rad > 0.0;
}

/// Vertical axis of the mount in the map: upright except for the tilt error, which is its two horizontal
/// components.
Vec3 upright(const Eigen::Isometry3d& pose, const PosePrior& prior) {
  return pose.linear() * prior.tilt.transpose().col(2);
}

void add_prior(const Eigen::Isometry3d& pose, const PosePrior& prior, Normal& normal) {
  normal.cost += prior_cost(pose, prior);
  if (tilt_is_known_about(prior)) {
    const double per_variance = 1.0 / square(*prior.tilt_sigma_rad);
    const Vec3 up = upright(pose, prior);
    Eigen::Matrix<double, 2, 3> by_rotation;
    by_rotation << 0.0, up.z(), -up.y(), -up.z(), 0.0, up.x();
    normal.information.bottomRightCorner<3, 3>() += per_variance * by_rotation.transpose() * by_rotation;
    normal.gradient.tail<3>() += per_variance * by_rotation.transpose() * up.head<2>();
  }
  if (prior.height_m) {
    const double per_variance = 1.0 / square(prior.height_sigma_m);
    normal.information(2, 2) += per_variance;
    normal.gradient[2] += per_variance * (pose.translation().z() - *prior.height_m);
  }
}

/// An exact tilt has no freedom about the horizontal axes: those rows mean "no step".
void forbid_tilting(Normal& normal) {
  for (const Eigen::Index axis : {3, 4}) {
    normal.information.row(axis).setZero();
    normal.information.col(axis).setZero();
    normal.information(axis, axis) = 1.0;
    normal.gradient[axis] = 0.0;
  }
}

std::optional<Normal> normal_at(const Eigen::Isometry3d& pose, const Sight& sight) {
  Normal normal;
  if (!add_sight(pose, sight, normal)) return std::nullopt;
  add_prior(pose, sight.options.prior, normal);
  if (tilt_is_exact(sight.options.prior)) forbid_tilting(normal);
  return normal;
}

/// The pose with the same position and heading, but with the prior's tilt.
Eigen::Isometry3d with_prior_tilt(const Eigen::Isometry3d& pose, const PosePrior& prior) {
  const Eigen::Matrix3d untilted = pose.linear() * prior.tilt.transpose();
  const Vec2 heading = Vec2(untilted(0, 0) + untilted(1, 1), untilted(1, 0) - untilted(0, 1)).normalized();
  Eigen::Matrix3d turned;
  turned << heading.x(), -heading.y(), 0.0, heading.y(), heading.x(), 0.0, 0.0, 0.0, 1.0;
  Eigen::Isometry3d result = pose;
  result.linear() = turned * prior.tilt;
  return result;
}

/// The inverse of the information, zero where the tilt is exact.
std::optional<Mat6> covariance_of(const Normal& normal, bool exact_tilt) {
  // Metres and radians are of similar magnitude here, so that the factorization needs no scaling.
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

/// Share of the dots' variance that is common to all frames, by their weight in a fix.
double shared_part(std::span<const SurveyedDot> dots) {
  double shared = 0.0;
  double sum = 0.0;
  for (const SurveyedDot& dot : dots) {
    const double weight = 1.0 / square(dot.sigma_px);
    shared += weight * square(dot.shared_sigma_px / dot.sigma_px);
    sum += weight;
  }
  return shared / sum;
}

Vec3 center_of(std::span<const SurveyedDot> dots) {
  Vec3 center = Vec3::Zero();
  for (const SurveyedDot& dot : dots) center += dot.point_in_map / static_cast<double>(dots.size());
  return center;
}

/// Deviation of a dot from its linear prediction after such a step: the second order of a perspective view.
double bend_px(const Vec6& step, const Eigen::Isometry3d& pose, std::span<const SurveyedDot> dots,
               const CameraModel& camera) {
  const double distance_m = (dots.front().point_in_map - pose.translation()).norm();
  const double turn_rad = step.head<3>().norm() / distance_m + step.tail<3>().norm();
  return std::max(camera.fx_px, camera.fy_px) * square(turn_rad);
}

double log_determinant(const Mat6& covariance) {
  return covariance.ldlt().vectorD().array().log().sum();
}

}  // namespace

std::optional<Projection> project_dot(const Eigen::Isometry3d& map_from_camera, const Vec3& point_in_map,
                                      const CameraModel& camera) {
  const auto in_camera = project_in_camera(map_from_camera, point_in_map, camera);
  if (!in_camera) return std::nullopt;
  Projection projection{.pixel = in_camera->pixel, .jacobian = {}};
  const auto in_map = [&](const Vec6& derivative) {
    Vec6 result;
    result << map_from_camera.linear() * derivative.head<3>(),
        map_from_camera.linear() * derivative.tail<3>();
    return result;
  };
  projection.jacobian.row(0) = in_map(in_camera->by_u);
  projection.jacobian.row(1) = in_map(in_camera->by_v);
  return projection;
}

double cost_of(const Eigen::Isometry3d& map_from_camera, std::span<const SurveyedDot> dots,
               const CameraModel& camera, const PoseFixOptions& options) {
  const Eigen::Isometry3d camera_from_map = map_from_camera.inverse();
  double cost = prior_cost(map_from_camera, options.prior);
  for (const SurveyedDot& dot : dots) {
    const std::optional<Vec2> seen = camera.project(camera_from_map * dot.point_in_map);
    if (!seen) return std::numeric_limits<double>::infinity();
    cost += huber((*seen - dot.center_px).squaredNorm() / square(dot.sigma_px), options.robust_scale).cost;
  }
  return cost;
}

double prior_cost(const Eigen::Isometry3d& map_from_camera, const PosePrior& prior) {
  double cost = 0.0;
  if (tilt_is_known_about(prior))
    cost += upright(map_from_camera, prior).head<2>().squaredNorm() / square(*prior.tilt_sigma_rad);
  if (prior.height_m)
    cost += square((map_from_camera.translation().z() - *prior.height_m) / prior.height_sigma_m);
  return cost;
}

std::optional<MapEstimate> maximize_posterior(const Eigen::Isometry3d& guess,
                                              std::span<const SurveyedDot> dots, const CameraModel& camera,
                                              const PoseFixOptions& options,
                                              std::span<const DotsOfMarker> markers) {
  const Sight sight{dots, markers, camera, options};
  const bool exact_tilt = tilt_is_exact(options.prior);
  Eigen::Isometry3d pose = exact_tilt ? with_prior_tilt(guess, options.prior) : guess;
  std::optional<Normal> normal = normal_at(pose, sight);
  if (!normal) return std::nullopt;

  double damping = 1e-6;
  constexpr int max_iterations = 40;
  constexpr double small_gain = 1e-3;  // of the cost: a last step of 0.03 sigma, of which a tenth remains
  constexpr double negligible_bend_px = 1e-4;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    Mat6 damped = normal->information;
    damped.diagonal() *= 1.0 + damping;
    const Vec6 step = -damped.ldlt().solve(normal->gradient);
    if (!step.allFinite()) return std::nullopt;
    const Eigen::Isometry3d candidate = moved(pose, step);
    const double expected_gain = -step.dot(normal->gradient);
    const bool is_straight = normal->is_quadratic && bend_px(step, pose, dots, camera) < negligible_bend_px;
    if (damping < 1e-3 && (expected_gain < small_gain || is_straight)) {
      pose = candidate;  // Newton's last step; its start is near enough for the covariance
      normal->cost -= expected_gain;
      break;
    }
    const std::optional<Normal> next = normal_at(candidate, sight);
    if (next && next->cost <= normal->cost) {
      pose = candidate;
      normal = next;
      damping = std::max(0.1 * damping, 1e-12);
    } else {
      damping *= 10.0;
      if (damping > 1e6) break;
    }
  }
  std::optional<Mat6> covariance = covariance_of(*normal, exact_tilt);
  if (!covariance) return std::nullopt;
  MapEstimate estimate{.map_from_camera = pose, .cost = normal->cost};
  estimate.chi2 = normal->cost - prior_cost(pose, options.prior);
  const double determined =
      normal->information_of_dots.cwiseProduct(*covariance).sum();  // the product's trace
  estimate.freedom = 2.0 * static_cast<double>(dots.size()) - determined;
  if (options.dot_place_sigma_m > 0.0)
    estimate.shared_covariance =
        shared_part(dots) *
        (*covariance * (normal->information_of_dots - normal->shared_of_gradient) * *covariance);
  if (!markers.empty()) estimate.shared_covariance += *covariance * normal->shared_of_gradient * *covariance;
  for (const Mat65& gradient : normal->gradient_by_offsets)
    estimate.by_offsets.emplace_back(-*covariance * gradient);  // Newton's step
  const Vec3 center_from_camera = center_of(dots) - pose.translation();
  estimate.covariance = *covariance;
  auto of_place = estimate.covariance.topLeftCorner<3, 3>();
  of_place += scale_covariance(center_from_camera, pose.linear().col(2), options.scale_sigma);
  if (!exact_tilt) of_place += arc_covariance(center_from_camera, *covariance);
  return estimate;
}

/// Laplace approximation of each mode: its probability is density times volume.
MapEstimate likelier(const MapEstimate& a, const MapEstimate& b) {
  const MapEstimate& best = a.cost <= b.cost ? a : b;
  const MapEstimate& other = a.cost <= b.cost ? b : a;
  const double log_ratio =
      0.5 * (best.cost - other.cost + log_determinant(other.covariance) - log_determinant(best.covariance));
  const double share = 1.0 / (1.0 + std::exp(-log_ratio));  // probability of the other mode
  if (!(share > 0.0)) return best;
  const Vec6 apart = step_between(best.map_from_camera, other.map_from_camera);
  MapEstimate result = best;
  result.covariance =
      (1.0 - share) * best.covariance + share * (other.covariance + apart * apart.transpose());
  result.shared_covariance = (1.0 - share) * best.shared_covariance + share * other.shared_covariance;
  for (Mat65& by_offset : result.by_offsets) by_offset *= std::sqrt(1.0 - share);
  return result;
}

}  // namespace lodestar
