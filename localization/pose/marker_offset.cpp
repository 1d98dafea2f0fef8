#include "localization/pose/marker_offset.hpp"

#include <Eigen/Cholesky>

#include "localization/detection/detected_marker.hpp"
#include "localization/pose/dot_projection.hpp"
#include "localization/pose/huber.hpp"

namespace lodestar {
namespace {

using Mat63 = Eigen::Matrix<double, 6, 3>;

/// A dot's residual, and its derivatives by the camera's pose and by the marker's offset.
struct LinearDot {
  Vec2 residual_px;
  Eigen::Matrix<double, 2, 6> by_pose;
  Eigen::Matrix<double, 2, 3> by_offset;
  double per_variance = 0.0;
};
using LinearDots = InlineVector<LinearDot, MarkerDots::static_capacity>;

/// A point that moves on the ceiling moves in the image as if the camera had moved the other way.
Eigen::Matrix<double, 2, 3> derivative_by_offset(const Eigen::Matrix<double, 2, 6>& by_pose,
                                                 const Eigen::Matrix3d& map_from_camera, const Vec2& arm_m) {
  const Eigen::Matrix<double, 2, 3> by_point = -by_pose.leftCols<3>() * map_from_camera.transpose();
  Eigen::Matrix<double, 2, 3> by_offset;
  by_offset.leftCols<2>() = by_point.leftCols<2>();
  by_offset.col(2) = by_point.leftCols<2>() * Vec2(-arm_m.y(), arm_m.x());
  return by_offset;
}

/// The dots' arms from dot O, turned and moved by the offset.
Vec3 moved(const Vec3& point_in_map, const Vec2& origin_m, const Vec3& offset) {
  const Vec2 arm_m = point_in_map.head<2>() - origin_m;
  const Vec2 there = origin_m + offset.head<2>() + Eigen::Rotation2Dd(offset[2]) * arm_m;
  return {there.x(), there.y(), point_in_map.z()};
}

/// At this offset: a turn by a degree is not linear to a hundredth of a pixel.
std::optional<LinearDots> linearize(const Eigen::Isometry3d& map_from_camera,
                                    std::span<const SurveyedDot> dots, const Vec2& origin_m,
                                    const Vec3& offset, const CameraModel& camera) {
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
  Mat63 mixed = Mat63::Zero();
  Eigen::Matrix3d offset = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 6, 1> gradient_of_pose = Eigen::Matrix<double, 6, 1>::Zero();
  Vec3 gradient_of_offset = Vec3::Zero();
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
  const Vec3 per_variance =
      Vec3(sigma.position_m, sigma.position_m, sigma.yaw_rad).array().square().inverse();
  constexpr int most_steps = 4;
  constexpr double small_step = 1e-8;  // metres and radians: 1e-5 px
  DotsWithOffset result;
  for (int step = 0;; ++step) {
    const auto linear = linearize(map_from_camera, dots, origin_m, result.offset, camera);
    if (!linear) return std::nullopt;
    const Sums sums = sums_of(*linear, robust_scale);
    Eigen::Matrix3d information = sums.offset;
    information.diagonal() += per_variance;
    const Eigen::LLT<Eigen::Matrix3d> factors(information);
    if (factors.info() != Eigen::Success) return std::nullopt;
    const Vec3 gradient = sums.gradient_of_offset + per_variance.cwiseProduct(result.offset);
    const Vec3 way = -factors.solve(gradient);
    if (step < most_steps && way.norm() > small_step) {
      result.offset += way;
      continue;
    }
    const Mat63 gain = factors.solve(sums.mixed.transpose()).transpose();
    result.information = sums.pose - gain * sums.mixed.transpose();
    result.shared_of_gradient = gain * per_variance.asDiagonal() * gain.transpose();
    result.gradient = sums.gradient_of_pose - gain * gradient;
    result.chi2_of_offset = result.offset.cwiseAbs2().dot(per_variance);
    result.cost = sums.cost + result.chi2_of_offset;
    result.is_quadratic = sums.is_quadratic;
    result.squared_px = sums.squared_px;
    return result;
  }
}

}  // namespace lodestar
