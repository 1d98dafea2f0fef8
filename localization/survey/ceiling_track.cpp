#include "localization/survey/ceiling_track.hpp"

namespace lodestar {
namespace {

/// Covariance of a * b, for covariances in the frames at their beginnings (Smith and Cheeseman 1986).
Eigen::Matrix3d covariance_of_product(const Pose2& a, const Eigen::Matrix3d& of_a, const Pose2& b,
                                      const Eigen::Matrix3d& of_b) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(a.yaw_rad).toRotationMatrix();
  const Vec2 arm = turn * b.position_m;
  Eigen::Matrix3d by_a = Eigen::Matrix3d::Identity();
  by_a.topRightCorner<2, 1>() << -arm.y(), arm.x();
  Eigen::Matrix3d by_b = Eigen::Matrix3d::Identity();
  by_b.topLeftCorner<2, 2>() = turn;
  return by_a * of_a * by_a.transpose() + by_b * of_b * by_b.transpose();
}

}  // namespace

CeilingTrack::CeilingTrack(std::span<const VisualOdometryIncrement> increments) {
  std::optional<Stamp> keyframe;
  for (const VisualOdometryIncrement& increment : increments) {
    if (keyframe && increment.from != *keyframe) next_keyframe_.emplace(*keyframe, increment.from);
    keyframe = increment.from;
    by_frames_.emplace(std::pair(increment.from, increment.to), increment);
    keyframe_of_[increment.to] = increment.from;
    keyframe_of_[increment.from] = increment.from;
  }
}

std::optional<CeilingTrack::Seen> CeilingTrack::seen_from(Stamp keyframe, Stamp frame) const {
  if (keyframe == frame) return Seen{.keyframe = keyframe, .keyframe_from_frame = {}};
  const auto found = by_frames_.find({keyframe, frame});
  if (found == by_frames_.end()) return std::nullopt;
  return Seen{keyframe, found->second.then_from_now, found->second.covariance};
}

std::optional<CeilingTrack::Seen> CeilingTrack::last_seen(Stamp frame) const {
  const auto keyframe = keyframe_of_.find(frame);
  return keyframe != keyframe_of_.end() ? seen_from(keyframe->second, frame) : std::nullopt;
}

std::optional<CeilingSegment> CeilingTrack::between(Stamp from, Stamp to) const {
  const std::optional<Seen> first = last_seen(from);
  if (!first) return std::nullopt;
  // From `from` back to its keyframe: the inverse of what was seen.
  const Pose2 back = inverse(first->keyframe_from_frame);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(back.yaw_rad).toRotationMatrix();
  Eigen::Matrix3d by_seen = -Eigen::Matrix3d::Identity();
  by_seen.topLeftCorner<2, 2>() = -turn;
  by_seen.topRightCorner<2, 1>() << back.position_m.y(), -back.position_m.x();
  CeilingSegment segment{.motion = back, .covariance = by_seen * first->covariance * by_seen.transpose()};
  const auto go_on = [&segment](const Seen& seen) {
    segment.covariance =
        covariance_of_product(segment.motion, segment.covariance, seen.keyframe_from_frame, seen.covariance);
    segment.motion = segment.motion * seen.keyframe_from_frame;
  };
  Stamp keyframe = first->keyframe;
  while (true) {
    if (const std::optional<Seen> last = seen_from(keyframe, to)) {
      go_on(*last);
      return segment;
    }
    const auto next = next_keyframe_.find(keyframe);
    if (next == next_keyframe_.end() || next->second > to) return std::nullopt;
    const std::optional<Seen> switched = seen_from(keyframe, next->second);
    if (!switched) return std::nullopt;
    go_on(*switched);
    keyframe = next->second;
  }
}

}  // namespace lodestar
