#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "localization/filter/belief_pose.hpp"

namespace lodestar {
namespace {

using Mat3 = Eigen::Matrix3d;

/// A belief, augmented by the pose that a frame of its time shows.
struct WithFramePose {
  using State = Eigen::Matrix<double, 16, 1>;
  using Covariance = Eigen::Matrix<double, 16, 16>;

  State mean;
  Covariance covariance;
};

WithFramePose with_frame_pose(const Belief& belief, double sway_m, const PoseFilterOptions& options) {
  WithFramePose both;
  const Eigen::Matrix<double, 3, 13> by_state = pose_by_state(belief);
  const Eigen::Matrix<double, 3, 13> with_state = by_state * belief.covariance;
  both.mean << belief.mean, pose_of(belief);
  both.covariance << belief.covariance, with_state.transpose(), with_state,
      with_state * by_state.transpose() + reading_covariance(belief, options);
  both.covariance.diagonal().segment<2>(13).array() += square(sway_m);
  return both;
}

/// The frame's pose replaces the keyframe's in the belief.
void set_keyframe(const WithFramePose& both, Belief& belief) {
  belief.mean = both.mean.head<13>();
  belief.mean.segment<3>(9) = both.mean.tail<3>();
  belief.covariance = both.covariance.topLeftCorner<13, 13>();
  belief.covariance.middleRows<3>(9) = both.covariance.bottomLeftCorner<3, 13>();
  belief.covariance.middleCols<3>(9) = both.covariance.topRightCorner<13, 3>();
  belief.covariance.block<3, 3>(9, 9) = both.covariance.bottomRightCorner<3, 3>();
}

struct MotionInnovation {
  Vec3 error;
  Mat3 covariance;
  Eigen::Matrix<double, 3, 16> by_state;
};

MotionInnovation innovation_of(const WithFramePose& both, const VisualOdometryIncrement& motion) {
  const Pose2 then{both.mean.segment<2>(9), both.mean[11]};
  const Pose2 expected = inverse(then) * Pose2{both.mean.segment<2>(13), both.mean[15]};
  const Eigen::Matrix2d then_from_map = Eigen::Rotation2Dd(-then.yaw_rad).toRotationMatrix();
  MotionInnovation innovation;
  innovation.error << motion.then_from_now.position_m - expected.position_m,
      wrap_angle(motion.then_from_now.yaw_rad - expected.yaw_rad);
  innovation.by_state.setZero();
  innovation.by_state.block<2, 2>(0, 9) = -then_from_map;
  innovation.by_state.block<2, 2>(0, 13) = then_from_map;
  innovation.by_state.col(11) << expected.position_m.y(), -expected.position_m.x(), -1.0;
  innovation.by_state(2, 15) = 1.0;
  innovation.covariance =
      innovation.by_state * both.covariance * innovation.by_state.transpose() + motion.covariance;
  return innovation;
}

}  // namespace

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
  const Eigen::Matrix<double, 16, 3> gain =
      innovation.covariance.ldlt().solve(innovation.by_state * both.covariance).transpose();
  const WithFramePose::Covariance keep = WithFramePose::Covariance::Identity() - gain * innovation.by_state;
  both.mean += gain * innovation.error;
  both.covariance =
      symmetric(keep * both.covariance * keep.transpose() + gain * motion.covariance * gain.transpose());
  Belief result = belief;
  result.mean = both.mean.head<13>();
  result.covariance = both.covariance.topLeftCorner<13, 13>();
  if (becomes_keyframe) {
    set_keyframe(both, result);
    result.keyframe_stamp = belief.travel.stamp;
  }
  result.mean[2] = wrap_angle(result.mean[2]);
  result.mean[11] = wrap_angle(result.mean[11]);
  return result;
}

}  // namespace lodestar
