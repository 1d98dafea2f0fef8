#include "localization/filter/belief.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

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

/// Covariance of the error that nearby fixes share: the site's part, and this fix's part from its markers.
Mat3 shared_covariance(const PlanarFix& fix, const PoseFilterOptions& options) {
  constexpr double least_sigma = 1e-6;  // m, rad: sharing() divides by it
  const double position = square(std::max(options.fix_sigma_floor_m, least_sigma));
  const Vec3 of_site(position, position, square(std::max(options.fix_sigma_floor_rad, least_sigma)));
  return fix.shared_covariance + Mat3(of_site.asDiagonal());
}

/// Covariance between pose and wheel readings from the readings' rounding. It is independent at each time and
/// must not accumulate along the way, as it would in moved().
Mat3 rounding_covariance(const PoseFilterOptions& options) {
  const double wheel = square(options.wheel_step_m) / 12.0;
  return Vec3(0.5 * wheel, 0.5 * wheel, 2.0 * wheel / square(options.track_width_m)).asDiagonal();
}

/// Covariance of the error that a fix does not share with others.
Mat3 own_covariance(const PlanarFix& fix, const PoseFilterOptions& options) {
  const Mat3 own = fix.covariance - fix.shared_covariance;
  return 0.5 * (own + own.transpose()) + rounding_covariance(options);
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
  return result;
}

/// A fix observes the pose plus the shared error.
struct Innovation {
  Vec3 error;
  Mat3 covariance;
  Eigen::Matrix<double, 3, 12> with_state;  ///< covariance of the expected fix and the state
};

Innovation innovation_of(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  Innovation innovation;
  const Vec3 expected = belief.mean.head<3>() + belief.mean.segment<3>(6);
  innovation.error << fix.map_from_base.position_m - expected.head<2>(),
      wrap_angle(fix.map_from_base.yaw_rad - expected.z());
  innovation.with_state = belief.covariance.topRows<3>() + belief.covariance.middleRows<3>(6);
  innovation.covariance = innovation.with_state.leftCols<3>() + innovation.with_state.middleCols<3>(6) +
                          own_covariance(fix, options);
  return innovation;
}

/// A belief, augmented by the pose that a frame of its time shows.
struct WithFramePose {
  using State = Eigen::Matrix<double, 15, 1>;
  using Covariance = Eigen::Matrix<double, 15, 15>;

  State mean;
  Covariance covariance;
};

WithFramePose with_frame_pose(const Belief& belief, double sway_m, const PoseFilterOptions& options) {
  WithFramePose both;
  both.mean << belief.mean, belief.mean.head<3>();
  both.covariance << belief.covariance, belief.covariance.leftCols<3>(), belief.covariance.topRows<3>(),
      belief.covariance.topLeftCorner<3, 3>() + rounding_covariance(options);
  both.covariance.diagonal().segment<2>(12).array() += square(sway_m);
  return both;
}

/// The frame's pose replaces the keyframe's in the belief.
void set_keyframe(const WithFramePose& both, Belief& belief) {
  belief.mean << both.mean.head<9>(), both.mean.tail<3>();
  belief.covariance << both.covariance.topLeftCorner<9, 9>(), both.covariance.topRightCorner<9, 3>(),
      both.covariance.bottomLeftCorner<3, 9>(), both.covariance.bottomRightCorner<3, 3>();
}

struct MotionInnovation {
  Vec3 error;
  Mat3 covariance;
  Eigen::Matrix<double, 3, 15> by_state;
};

MotionInnovation innovation_of(const WithFramePose& both, const VisualOdometryIncrement& motion) {
  const Pose2 then{both.mean.segment<2>(9), both.mean[11]};
  const Pose2 expected = inverse(then) * Pose2{both.mean.segment<2>(12), both.mean[14]};
  const Eigen::Matrix2d then_from_map = Eigen::Rotation2Dd(-then.yaw_rad).toRotationMatrix();
  MotionInnovation innovation;
  innovation.error << motion.then_from_now.position_m - expected.position_m,
      wrap_angle(motion.then_from_now.yaw_rad - expected.yaw_rad);
  innovation.by_state.setZero();
  innovation.by_state.block<2, 2>(0, 9) = -then_from_map;
  innovation.by_state.block<2, 2>(0, 12) = then_from_map;
  innovation.by_state.col(11) << expected.position_m.y(), -expected.position_m.x(), -1.0;
  innovation.by_state(2, 14) = 1.0;
  innovation.covariance =
      innovation.by_state * both.covariance * innovation.by_state.transpose() + motion.covariance;
  return innovation;
}

}  // namespace

WheelScales scales_as_built(const PoseFilterOptions& options) {
  WheelScales scales;
  const double wheel = square(options.initial_wheel_scale_sigma);
  scales.covariance = Vec3(wheel, wheel, square(options.initial_turn_scale_sigma)).asDiagonal();
  return scales;
}

Belief belief_from(const PlanarFix& fix, const WheelTravel& travel, const WheelScales& scales,
                   const PoseFilterOptions& options) {
  Belief belief;
  belief.travel = travel;
  belief.mean << fix.map_from_base.position_m, fix.map_from_base.yaw_rad, scales.mean, Vec3::Zero(),
      Vec3::Zero();
  const Mat3 shared = shared_covariance(fix, options);
  for (const int id : fix.ids) belief.markers.push_back({id, rolled_m(travel)});
  belief.shared = shared;
  belief.covariance.topLeftCorner<3, 3>() = own_covariance(fix, options) + shared;
  belief.covariance.block<3, 3>(0, 6) = -shared;
  belief.covariance.block<3, 3>(6, 0) = -shared;
  belief.covariance.block<3, 3>(6, 6) = shared;
  belief.covariance.block<3, 3>(3, 3) = scales.covariance;
  return belief;
}

Belief moved(const Belief& from, const WheelTravel& travel, const PoseFilterOptions& options) {
  const double left_m = travel.left_m - from.travel.left_m;
  const double right_m = travel.right_m - from.travel.right_m;
  const double left_scale = from.mean[3];
  const double right_scale = from.mean[4];
  const double turn_scale = from.mean[5];
  const double turn_as_built = (right_scale * right_m - left_scale * left_m) / options.track_width_m;
  const Arc arc{0.5 * (left_scale * left_m + right_scale * right_m), turn_scale * turn_as_built};
  const Pose2 pose = along(from.map_from_base(), arc);
  const double way_m = 0.5 * (std::abs(left_m) + std::abs(right_m));
  const double kept = std::exp(-way_m / fix_bias_reach_m);  // correlation of the shared error

  Belief to = from;
  to.travel = travel;
  to.mean.head<3>() << pose.position_m, pose.yaw_rad;
  to.mean.segment<3>(6) *= kept;

  const Eigen::Matrix<double, 3, 2> by_arc = pose_by_arc(from.mean[2], arc);
  Eigen::Matrix2d arc_by_wheels;
  const double turn_per_m = turn_scale / options.track_width_m;
  arc_by_wheels << 0.5, 0.5, -turn_per_m, turn_per_m;
  const Eigen::Matrix<double, 3, 2> by_wheels = by_arc * arc_by_wheels;

  Belief::Covariance transition = Belief::Covariance::Identity();
  transition(0, 2) = -(pose.position_m.y() - from.mean.y());
  transition(1, 2) = pose.position_m.x() - from.mean.x();
  transition.block<3, 1>(0, 3) = by_wheels.col(0) * left_m;
  transition.block<3, 1>(0, 4) = by_wheels.col(1) * right_m;
  transition.block<3, 1>(0, 5) = by_arc.col(1) * turn_as_built;
  transition.diagonal().segment<3>(6).setConstant(kept);

  const Vec2 noise = square(options.wheel_noise_m_per_sqrt_m) * Vec2(std::abs(left_m), std::abs(right_m));
  to.covariance.noalias() = transition * from.covariance * transition.transpose();
  to.covariance.topLeftCorner<3, 3>() += by_wheels * noise.asDiagonal() * by_wheels.transpose();
  to.covariance.diagonal().segment<3>(3).array() += square(options.wheel_scale_drift_per_sqrt_m) * way_m;
  to.covariance.block<3, 3>(6, 6) += (1.0 - kept * kept) * from.shared;
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

Belief corrected(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options) {
  const Belief expected = sharing(belief, fix, options);
  const Innovation innovation = innovation_of(expected, fix, options);
  Eigen::Matrix<double, 12, 3> gain = innovation.covariance.ldlt().solve(innovation.with_state).transpose();
  gain.middleRows<3>(3) *= options.scales_learned_by_one_fix;
  Belief::Covariance keep = Belief::Covariance::Identity();
  keep.leftCols<3>() -= gain;
  keep.middleCols<3>(6) -= gain;
  Belief result = expected;
  result.mean += gain * innovation.error;
  result.mean[2] = wrap_angle(result.mean[2]);
  // Joseph form: keeps the covariance symmetric and positive, and is correct for any gain.
  result.covariance =
      keep * expected.covariance * keep.transpose() + gain * own_covariance(fix, options) * gain.transpose();
  return result;
}

Belief with_keyframe(const Belief& belief, double sway_m, const PoseFilterOptions& options) {
  Belief result = belief;
  set_keyframe(with_frame_pose(belief, sway_m, options), result);
  result.keyframe_stamp = belief.travel.stamp;
  return result;
}

double squared_distance(const Belief& belief, const VisualOdometryIncrement& motion,
                        const PoseFilterOptions& options) {
  const MotionInnovation innovation = innovation_of(with_frame_pose(belief, motion.sway_m, options), motion);
  return innovation.error.dot(innovation.covariance.ldlt().solve(innovation.error));
}

Belief corrected(const Belief& belief, const VisualOdometryIncrement& motion, bool becomes_keyframe,
                 const PoseFilterOptions& options) {
  WithFramePose both = with_frame_pose(belief, motion.sway_m, options);
  const MotionInnovation innovation = innovation_of(both, motion);
  const Eigen::Matrix<double, 15, 3> gain =
      innovation.covariance.ldlt().solve(innovation.by_state * both.covariance).transpose();
  const WithFramePose::Covariance keep = WithFramePose::Covariance::Identity() - gain * innovation.by_state;
  both.mean += gain * innovation.error;
  both.covariance =
      (keep * both.covariance * keep.transpose() + gain * motion.covariance * gain.transpose()).eval();
  Belief result = belief;
  result.mean = both.mean.head<12>();
  result.covariance = both.covariance.topLeftCorner<12, 12>();
  if (becomes_keyframe) {
    set_keyframe(both, result);
    result.keyframe_stamp = belief.travel.stamp;
  }
  result.mean[2] = wrap_angle(result.mean[2]);
  result.mean[11] = wrap_angle(result.mean[11]);
  return result;
}

Mat3 pose_covariance(const Belief& belief, const PoseFilterOptions& options) {
  return belief.covariance.topLeftCorner<3, 3>() + rounding_covariance(options);
}

Pose2 rolled(const Pose2& from, double left_m, double right_m, double track_width_m) {
  return along(from, {0.5 * (left_m + right_m), (right_m - left_m) / track_width_m});
}

}  // namespace lodestar
