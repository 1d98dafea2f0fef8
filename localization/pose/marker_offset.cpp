#include "localization/pose/marker_offset.hpp"

#include <Eigen/Cholesky>

#include "localization/detection/detected_marker.hpp"
#include "localization/pose/dot_projection.hpp"
#include "localization/pose/huber.hpp"

namespace lodestar {
namespace {

using Mat5 = Eigen::Matrix<double, 5, 5>;

/// A dot's residual, and its derivatives by the camera's pose and by the marker's offset.
struct LinearDot {
  Vec2 residual_px;
  Eigen::Matrix<double, 2, 6> by_pose;
  Eigen::Matrix<double, 2, 5> by_offset;
  double per_variance = 0.0;
};
using LinearDots = InlineVector<LinearDot, MarkerDots::static_capacity>;

/// A point that moves on the ceiling moves in the image as if the camera had moved the other way.
Eigen::Matrix<double, 2, 5> derivative_by_offset(const Eigen::Matrix<double, 2, 6>& by_pose,
                                                 const Eigen::Matrix3d& map_from_camera, const Vec2& arm_m) {
  const Eigen::Matrix<double, 2, 3> by_point = -by_pose.leftCols<3>() * map_from_camera.transpose();
  Eigen::Matrix<double, 2, 5> by_offset;
  by_offset.leftCols<2>() = by_point.leftCols<2>();
  by_offset.col(2) = by_point.leftCols<2>() * Vec2(-arm_m.y(), arm_m.x());
  by_offset.col(3) = by_point.col(2) * arm_m.y();
  by_offset.col(4) = by_point.col(2) * -arm_m.x();
  return by_offset;
}

/// The dots' arms from dot O, turned, tilted and moved by the offset. A tilt of a degree shortens an arm by
/// 0.02 %, which is left out.
Vec3 moved(const Vec3& point_in_map, const Vec2& origin_m, const Vec5& offset) {
  const Vec2 arm_m = Eigen::Rotation2Dd(offset[2]) * (point_in_map.head<2>() - origin_m);
  const Vec2 there = origin_m + offset.head<2>() + arm_m;
  return {there.x(), there.y(), point_in_map.z() + offset[3] * arm_m.y() - offset[4] * arm_m.x()};
}

/// At this offset: a turn by a degree is not linear to a hundredth of a pixel.
std::optional<LinearDots> linearize(const Eigen::Isometry3d& map_from_camera,
                                    std::span<const SurveyedDot> dots, const Vec2& origin_m,
                                    const Vec5& offset, const CameraModel& camera) {
  LinearDots linear;
  for (const SurveyedDot& dot : dots) {
    const Vec3 point = moved(dot.point_in_map, origin_m, offset);
    const auto seen = project_in_camera(map_from_camera, point, camera);
    if (!seen) return std::nullopt;
    LinearDot next{.residual_px = seen->pixel - dot.center_px,
                   .by_pose = {},
                   .by_offset = {},
                   .per_variance = 1.0 / square(dot.sigma_px)};
    next.by_pose << seen->by_u.transpose(), seen->by_v.transpose();
    const Vec2 arm_m = point.head<2>() - origin_m - offset.head<2>();
    next.by_offset = derivative_by_offset(next.by_pose, map_from_camera.linear(), arm_m);
    linear.push_back(next);
  }
  return linear;
}

/// Sums over the dots, with the weights of their Huber losses.
struct Sums {
  Eigen::Matrix<double, 6, 6> pose = Eigen::Matrix<double, 6, 6>::Zero();
  Mat65 mixed = Mat65::Zero();
  Mat5 offset = Mat5::Zero();
  Eigen::Matrix<double, 6, 1> gradient_of_pose = Eigen::Matrix<double, 6, 1>::Zero();
  Vec5 gradient_of_offset = Vec5::Zero();
  double cost = 0.0;
  double squared_px = 0.0;
  bool is_quadratic = true;
};

Sums sums_of(const LinearDots& dots, double robust_scale) {
  Sums sums;
  for (const LinearDot& dot : dots) {
    const double squared_px = dot.residual_px.squaredNorm();
    const Huber loss = huber(squared_px * dot.per_variance, robust_scale);
    const double weight = dot.per_variance * loss.weight;
    sums.pose += weight * dot.by_pose.transpose() * dot.by_pose;
    sums.mixed += weight * dot.by_pose.transpose() * dot.by_offset;
    sums.offset += weight * dot.by_offset.transpose() * dot.by_offset;
    sums.gradient_of_pose += weight * dot.by_pose.transpose() * dot.residual_px;
    sums.gradient_of_offset += weight * dot.by_offset.transpose() * dot.residual_px;
    sums.cost += loss.cost;
    sums.squared_px += squared_px;
    sums.is_quadratic = sums.is_quadratic && loss.weight == 1.0;
  }
  return sums;
}

}  // namespace

std::optional<DotsWithOffset> eliminate_offset(const Eigen::Isometry3d& map_from_camera,
                                               std::span<const SurveyedDot> dots, const Vec2& origin_m,
                                               const MarkerSigma& sigma, const CameraModel& camera,
                                               double robust_scale) {
  // In sigmas, so that what is exact (a sigma of 0) needs no case of its own.
  Vec5 scale;
  scale << sigma.position_m, sigma.position_m, sigma.yaw_rad, sigma.tilt_rad, sigma.tilt_rad;
  constexpr int most_steps = 4;
  constexpr double small_step = 1e-5;  // of a sigma
  DotsWithOffset result;
  Vec5 in_sigmas = Vec5::Zero();
  for (int step = 0;; ++step) {
    result.offset = scale.cwiseProduct(in_sigmas);
    const auto linear = linearize(map_from_camera, dots, origin_m, result.offset, camera);
    if (!linear) return std::nullopt;
    const Sums sums = sums_of(*linear, robust_scale);
    const Mat5 information = scale.asDiagonal() * sums.offset * scale.asDiagonal() + Mat5::Identity();
    const Eigen::LLT<Mat5> factors(information);
    if (factors.info() != Eigen::Success) return std::nullopt;
    const Vec5 gradient = scale.cwiseProduct(sums.gradient_of_offset) + in_sigmas;
    const Vec5 way = -factors.solve(gradient);
    if (step < most_steps && way.norm() > small_step) {
      in_sigmas += way;
      continue;
    }
    const Mat65 mixed = sums.mixed * scale.asDiagonal();
    const Mat65 gain = factors.solve(mixed.transpose()).transpose();
    result.information = sums.pose - gain * mixed.transpose();
    result.gradient_by_offset = -gain;
    result.gradient = sums.gradient_of_pose - gain * gradient;
    result.chi2_of_offset = in_sigmas.squaredNorm();
    result.cost = sums.cost + result.chi2_of_offset;
    result.is_quadratic = sums.is_quadratic;
    result.squared_px = sums.squared_px;
    return result;
  }
}

}  // namespace lodestar
