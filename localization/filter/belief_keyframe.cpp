#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "localization/filter/belief_pose.hpp"

namespace lodestar {
namespace {

using Mat3 = Eigen::Matrix3d;

/// A belief, augmented by the pose that a frame of its time shows, which is last.
struct WithFramePose {
  static constexpr int most_states = Belief::most_states + 3;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_states, most_states>;
  using ByState = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, most_states>;
  using Gain = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most_states, 3>;

  State mean;
  Covariance covariance;
};

WithFramePose with_frame_pose(const Belief& belief, double sway_m, const PoseFilterOptions& options) {
  WithFramePose both;
  const Eigen::Index size = belief.mean.size();
  const Belief::ByState by_state = pose_by_state(belief);
  const Belief::ByState with_state = by_state * belief.covariance;
  both.mean.resize(size + 3);
  both.mean << belief.mean, pose_of(belief);
  both.covariance.resize(size + 3, size + 3);
  both.covariance << belief.covariance, with_state.transpose(), with_state,
      with_state * by_state.transpose() + reading_covariance(belief, options);
  both.covariance.diagonal().segment<2>(size).array() += square(sway_m);
  return both;
}

void take_belief(const WithFramePose& both, Belief& belief) {
  const Eigen::Index size = belief.mean.size();
  belief.mean = both.mean.head(size);
  belief.covariance = both.covariance.topLeftCorner(size, size);
}

/// The frame's pose replaces the keyframe's in the belief.
void take_keyframe(const WithFramePose& both, Belief& belief) {
  const Eigen::Index size = belief.mean.size();
  belief.mean.segment<3>(9) = both.mean.tail<3>();
  belief.covariance.middleRows<3>(9) = both.covariance.bottomLeftCorner(3, size);
  belief.covariance.middleCols<3>(9) = both.covariance.topRightCorner(size, 3);
  belief.covariance.block<3, 3>(9, 9) = both.covariance.bottomRightCorner<3, 3>();
  belief.keyframe_stamp = belief.travel.stamp;
}

struct MotionInnovation {
  Vec3 error;
  Mat3 covariance;
  WithFramePose::ByState by_state;
};

MotionInnovation innovation_of(const WithFramePose& both, const VisualOdometryIncrement& motion) {
  const Eigen::Index now = both.mean.size() - 3;
  const Pose2 then{both.mean.segment<2>(9), both.mean[11]};
  const Pose2 expected = inverse(then) * Pose2{both.mean.segment<2>(now), both.mean[now + 2]};
  const Eigen::Matrix2d then_from_map = Eigen::Rotation2Dd(-then.yaw_rad).toRotationMatrix();
  MotionInnovation innovation;
  innovation.error << motion.then_from_now.position_m - expected.position_m,
      wrap_angle(motion.then_from_now.yaw_rad - expected.yaw_rad);
  innovation.by_state.setZero(3, both.mean.size());
  innovation.by_state.block<2, 2>(0, 9) = -then_from_map;
  innovation.by_state.block<2, 2>(0, now) = then_from_map;
  innovation.by_state.col(11) << expected.position_m.y(), -expected.position_m.x(), -1.0;
  innovation.by_state(2, now + 2) = 1.0;
  innovation.covariance =
      innovation.by_state * both.covariance * innovation.by_state.transpose() + motion.covariance;
  return innovation;
}

}  // namespace

Belief with_keyframe(const Belief& belief, double sway_m, const PoseFilterOptions& options) {
  Belief result = belief;
  take_keyframe(with_frame_pose(belief, sway_m, options), result);
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
  const WithFramePose::Gain gain =
      innovation.covariance.ldlt().solve(innovation.by_state * both.covariance).transpose();
  both.mean += gain * innovation.error;
  both.covariance = after_correction(both.covariance, gain, innovation.by_state, motion.covariance);
  Belief result = belief;
  take_belief(both, result);
  if (becomes_keyframe) take_keyframe(both, result);
  result.mean[2] = wrap_angle(result.mean[2]);
  result.mean[11] = wrap_angle(result.mean[11]);
  return result;
}

}  // namespace lodestar
