#include "localization/filter/belief.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "localization/filter/belief_offsets.hpp"
#include "localization/filter/belief_pose.hpp"
#include "maps/chi_square.hpp"

namespace lodestar {
namespace {

using Mat3 = Eigen::Matrix3d;

/// Motion on an arc of constant curvature.
struct Arc {
  double length_m = 0.0;
  double turn_rad = 0.0;
};

Pose2 along(const Pose2& from, const Arc& arc) {
  const double half = 0.5 * arc.turn_rad;
  const double chord_m = std::abs(half) < 1e-6 ? arc.length_m : arc.length_m * std::sin(half) / half;
  const double direction = from.yaw_rad + half;
  return {from.position_m + chord_m * Vec2(std::cos(direction), std::sin(direction)),
          wrap_angle(from.yaw_rad + arc.turn_rad)};
}

/// Derivative of the pose after an arc by its length and turn; the chord approximates the arc.
Eigen::Matrix<double, 3, 2> pose_by_arc(double yaw_rad, const Arc& arc) {
  const double direction = yaw_rad + 0.5 * arc.turn_rad;
  const Vec2 ahead(std::cos(direction), std::sin(direction));
  const Vec2 aside(-ahead.y(), ahead.x());
  Eigen::Matrix<double, 3, 2> jacobian;
  jacobian << ahead, 0.5 * arc.length_m * aside, 0.0, 1.0;
  return jacobian;
}

/// Correlation length of the error that nearby fixes share: about the distance on which the same markers stay
/// in view. Assumed.
constexpr double fix_bias_reach_m = 1.0;

/// Covariance of the error that nearby fixes share: the site's part, and this fix's part from its markers but
/// for the offsets that the belief has one by one.
Mat3 shared_covariance(const PlanarFix& fix, const PoseFilterOptions& options) {
  constexpr double least_sigma = 1e-6;  // m, rad: sharing() divides by it
  const double position = square(std::max(options.fix_sigma_floor_m, least_sigma));
  const Vec3 of_site(position, position, square(std::max(options.fix_sigma_floor_rad, least_sigma)));
  Mat3 shared = fix.shared_covariance + Mat3(of_site.asDiagonal());
  for (const PlanarByOffset& by_offset : fix.by_offsets)
    shared -= by_offset.jacobian * by_offset.jacobian.transpose();
  return shared;
}

/// Covariance of the readings' rounding.
Mat3 rounding_covariance(const PoseFilterOptions& options) {
  const double wheel = square(options.wheel_step_m) / 12.0;
  return Vec3(0.5 * wheel, 0.5 * wheel, 2.0 * wheel / square(options.track_width_m)).asDiagonal();
}

/// What the robot's pose (x_m, y_m, yaw_rad) changes by in a second.
Vec3 velocity_in_map(const Belief& belief) {
  const double yaw_rad = belief.mean[2];
  return {belief.velocity.forward_mps * std::cos(yaw_rad), belief.velocity.forward_mps * std::sin(yaw_rad),
          belief.velocity.turn_radps};
}

/// Covariance of the error that a fix does not share with others.
Mat3 own_covariance(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  const Mat3 own = fix.covariance - fix.shared_covariance;
  return 0.5 * (own + own.transpose()) + reading_covariance(belief, options);
}

double rolled_m(const WheelTravel& travel) {
  return 0.5 * (travel.left_m + travel.right_m);
}

bool rests_on(const PlanarFix& fix, int id) {
  return std::ranges::find(fix.ids, id) != fix.ids.end();
}

/// Share of the common error that this fix has: each marker has its own error, so a marker not seen nearby
/// contributes an independent one.
double share_kept(const std::vector<RecentMarker>& markers, const PlanarFix& fix) {
  if (fix.ids.empty()) return 1.0;
  const auto known =
      std::ranges::count_if(markers, [&](const RecentMarker& marker) { return rests_on(fix, marker.id); });
  return std::sqrt(static_cast<double>(known) / static_cast<double>(fix.ids.size()));
}

/// The belief with the common error of this fix: as far as its markers were seen nearby, the old error, at
/// the same number of sigmas.
Belief sharing(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  Belief result = belief;
  const double here_m = rolled_m(belief.travel);
  std::erase_if(result.markers, [&](const RecentMarker& marker) {
    return std::abs(here_m - marker.rolled_m) > fix_bias_reach_m;
  });
  const double kept = share_kept(result.markers, fix);
  std::erase_if(result.markers, [&](const RecentMarker& marker) { return rests_on(fix, marker.id); });
  for (const int id : fix.ids) result.markers.push_back({id, here_m});

  result.shared = shared_covariance(fix, options);
  const Mat3 before = belief.shared.llt().matrixL();
  const Mat3 after = result.shared.llt().matrixL();
  const Mat3 scale = kept * after * before.inverse();
  result.mean.segment<3>(6) = scale * belief.mean.segment<3>(6);
  result.covariance.middleRows<3>(6) = scale * result.covariance.middleRows<3>(6);
  result.covariance.middleCols<3>(6) = result.covariance.middleCols<3>(6) * scale.transpose();
  result.covariance.block<3, 3>(6, 6) += (1.0 - kept * kept) * result.shared;
  remember_offsets(fix, result);
  return result;
}

struct Innovation {
  Vec3 error;
  Mat3 covariance;
  Belief::ByState by_state;
};

Innovation innovation_of(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  Innovation innovation;
  innovation.by_state = fix_by_state(belief, fix);
  const Eigen::Index offsets = belief.mean.size() - Belief::own_states;
  const Vec3 expected = pose_of(belief) + belief.mean.segment<3>(6) +
                        innovation.by_state.rightCols(offsets) * belief.mean.tail(offsets);
  innovation.error << fix.map_from_base.position_m - expected.head<2>(),
      wrap_angle(fix.map_from_base.yaw_rad - expected.z());
  innovation.covariance = innovation.by_state * belief.covariance * innovation.by_state.transpose() +
                          own_covariance(belief, fix, options);
  return innovation;
}

/// Drift of the readings' mean lag, beside that by their jitter. Assumed: a bus whose load changes.
constexpr double lag_drift_s_per_sqrt_s = 0.0005;

/// The velocity with another arc, averaged over two readings, and longer where their jitter makes half a
/// metre per second of nothing. Chosen by hand.
BodyVelocity smoothed(const BodyVelocity& before, const Arc& arc, double time_s,
                      const PoseFilterOptions& options) {
  if (time_s <= 0.0) return before;
  const double weight = -std::expm1(-time_s / (0.04 + 6.0 * options.reading_jitter_s));
  const BodyVelocity now{std::lerp(before.forward_mps, arc.length_m / time_s, weight),
                         std::lerp(before.turn_radps, arc.turn_rad / time_s, weight)};
  const bool rests = arc.length_m == 0.0 && arc.turn_rad == 0.0 && std::abs(now.forward_mps) < 1e-3 &&
                     std::abs(now.turn_radps) < 1e-3;
  return rests ? BodyVelocity{} : now;  // a robot at rest does not creep
}

}  // namespace

Vec3 pose_of(const Belief& belief) {
  return belief.mean.head<3>() + belief.mean[12] * velocity_in_map(belief);
}

Belief::ByState pose_by_state(const Belief& belief) {
  Belief::ByState jacobian = Belief::ByState::Zero(3, belief.mean.size());
  jacobian.leftCols<3>().setIdentity();
  jacobian.col(12) = velocity_in_map(belief);
  return jacobian;
}

Mat3 reading_covariance(const Belief& belief, const PoseFilterOptions& options) {
  const Vec3 jitter = options.reading_jitter_s * velocity_in_map(belief);
  return rounding_covariance(options) + jitter * jitter.transpose();
}

Pose2 Belief::map_from_base() const {
  const Vec3 pose = pose_of(*this);
  return {pose.head<2>(), wrap_angle(pose.z())};
}

WheelScales initial_scales(const PoseFilterOptions& options) {
  if (options.learned_scales) return *options.learned_scales;
  WheelScales scales;
  const double wheel = square(options.initial_wheel_scale_sigma);
  scales.covariance = Vec3(wheel, wheel, square(options.initial_turn_scale_sigma)).asDiagonal();
  return scales;
}

Belief belief_from(const PlanarFix& fix, const WheelTravel& travel, const WheelScales& scales,
                   const PoseFilterOptions& options, const Lag& lag) {
  Belief belief;
  belief.travel = travel;
  belief.mean << fix.map_from_base.position_m, fix.map_from_base.yaw_rad, scales.mean, Vec3::Zero(),
      Vec3::Zero(), lag.mean_s;
  const Mat3 shared = shared_covariance(fix, options);
  for (const int id : fix.ids) belief.markers.push_back({id, rolled_m(travel)});
  belief.shared = shared;
  belief.covariance.topLeftCorner<3, 3>() = own_covariance(belief, fix, options) + shared;
  belief.covariance.block<3, 3>(0, 6) = -shared;
  belief.covariance.block<3, 3>(6, 0) = -shared;
  belief.covariance.block<3, 3>(6, 6) = shared;
  belief.covariance.block<3, 3>(3, 3) = scales.covariance;
  belief.covariance(12, 12) = square(lag.sigma_s);
  belief.registry_variance = options.registry_variance;
  remember_offsets(fix, belief);
  const Belief::ByState by_state = fix_by_state(belief, fix);
  const Eigen::Index offsets = belief.mean.size() - Belief::own_states;
  const Belief::ByState by_offsets = by_state.rightCols(offsets);
  const Belief::ByState with_offsets = by_offsets * belief.covariance.bottomRightCorner(offsets, offsets);
  belief.covariance.topLeftCorner<3, 3>() += with_offsets * by_offsets.transpose();
  belief.covariance.topRightCorner(3, offsets) = -with_offsets;
  belief.covariance.bottomLeftCorner(offsets, 3) = -with_offsets.transpose();
  return belief;
}

Belief moved(const Belief& from, const WheelTravel& travel, const PoseFilterOptions& options) {
  if (from.registry_variance != options.registry_variance)
    return moved(with_registry_variance(from, options.registry_variance), travel, options);
  const double left_m = travel.left_m - from.travel.left_m;
  const double right_m = travel.right_m - from.travel.right_m;
  const double left_scale = from.mean[3];
  const double right_scale = from.mean[4];
  const double turn_scale = from.mean[5];
  const double turn_as_built = (right_scale * right_m - left_scale * left_m) / options.track_width_m;
  const Arc arc{0.5 * (left_scale * left_m + right_scale * right_m), turn_scale * turn_as_built};
  const Pose2 pose = along({from.mean.head<2>(), from.mean[2]}, arc);
  const double way_m = 0.5 * (std::abs(left_m) + std::abs(right_m));
  const double kept = std::exp(-way_m / fix_bias_reach_m);  // correlation of the shared error

  const double time_s = seconds(travel.stamp - from.travel.stamp);

  Belief to = from;
  to.travel = travel;
  to.velocity = smoothed(from.velocity, arc, time_s, options);
  to.mean.head<3>() << pose.position_m, pose.yaw_rad;
  to.mean.segment<3>(6) *= kept;

  const Eigen::Matrix<double, 3, 2> by_arc = pose_by_arc(from.mean[2], arc);
  Eigen::Matrix2d arc_by_wheels;
  const double turn_per_m = turn_scale / options.track_width_m;
  arc_by_wheels << 0.5, 0.5, -turn_per_m, turn_per_m;
  const Eigen::Matrix<double, 3, 2> by_wheels = by_arc * arc_by_wheels;

  using Transition = Eigen::Matrix<double, Belief::own_states, Belief::own_states>;
  Transition transition = Transition::Identity();
  transition(0, 2) = -(pose.position_m.y() - from.mean.y());
  transition(1, 2) = pose.position_m.x() - from.mean.x();
  transition.block<3, 1>(0, 3) = by_wheels.col(0) * left_m;
  transition.block<3, 1>(0, 4) = by_wheels.col(1) * right_m;
  transition.block<3, 1>(0, 5) = by_arc.col(1) * turn_as_built;
  transition.diagonal().segment<3>(6).setConstant(kept);

  const Vec2 noise = square(options.wheel_noise_m_per_sqrt_m) * Vec2(std::abs(left_m), std::abs(right_m));
  constexpr int own = Belief::own_states;
  const Eigen::Index offsets = from.mean.size() - own;
  to.covariance.topLeftCorner<own, own>() =
      transition * from.covariance.topLeftCorner<own, own>() * transition.transpose();
  to.covariance.topRightCorner(own, offsets).noalias() =
      transition * from.covariance.topRightCorner(own, offsets);
  to.covariance.bottomLeftCorner(offsets, own) = to.covariance.topRightCorner(own, offsets).transpose();
  to.covariance.topLeftCorner<3, 3>() += by_wheels * noise.asDiagonal() * by_wheels.transpose();
  to.covariance.diagonal().segment<3>(3).array() += square(options.wheel_scale_drift_per_sqrt_m) * way_m;
  to.covariance.block<3, 3>(6, 6) += (1.0 - kept * kept) * from.shared;
  to.covariance(12, 12) += (square(lag_drift_s_per_sqrt_s) + square(options.reading_jitter_s)) * time_s;
  return to;
}

double gate_squared_distance() {
  static const double gate = chi_square_quantile(0.999, 3.0);
  return gate;
}

double squared_distance(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  const Innovation innovation = innovation_of(sharing(belief, fix, options), fix, options);
  return innovation.error.dot(innovation.covariance.ldlt().solve(innovation.error));
}

double log_density(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  const Innovation innovation = innovation_of(sharing(belief, fix, options), fix, options);
  const Eigen::LDLT<Mat3> factors(innovation.covariance);
  return -0.5 * (innovation.error.dot(factors.solve(innovation.error)) +
                 factors.vectorD().array().log().sum() + 3.0 * std::log(2.0 * std::numbers::pi));
}

Belief corrected(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  const Belief expected = sharing(belief, fix, options);
  const Innovation innovation = innovation_of(expected, fix, options);
  Belief::Gain gain =
      innovation.covariance.ldlt().solve(innovation.by_state * expected.covariance).transpose();
  gain.middleRows<3>(3) *= options.scales_learned_by_one_fix;
  Belief result = expected;
  result.mean += gain * innovation.error;
  result.mean[2] = wrap_angle(result.mean[2]);
  result.covariance = after_correction(expected.covariance, gain, innovation.by_state,
                                       own_covariance(expected, fix, options));
  return result;
}

Mat3 pose_covariance(const Belief& belief, const PoseFilterOptions& options) {
  const Belief::ByState by_state = pose_by_state(belief);
  return by_state * belief.covariance * by_state.transpose() + reading_covariance(belief, options);
}

Pose2 rolled(const Pose2& from, double left_m, double right_m, double track_width_m) {
  return along(from, {0.5 * (left_m + right_m), (right_m - left_m) / track_width_m});
}

}  // namespace lodestar
