#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>

#include "localization/ceiling/visual_odometry_increment.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// Motion of the base between two frames by the ceiling's texture, in its frame at the first: if the ceiling
/// is as high and the camera mounted as was believed when it was seen, and the body did not sway.
struct CeilingSegment {
  Pose2 motion;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x_m, y_m, yaw_rad), but for sway
};

/// Increments of visual odometry, each from the keyframe of its time, joined to motions between any two
/// frames.
class CeilingTrack {
 public:
  explicit CeilingTrack(std::span<const VisualOdometryIncrement> increments);

  /// Nothing where the ceiling was lost between, or a frame was too near its keyframe to be registered.
  [[nodiscard]] std::optional<CeilingSegment> between(Stamp from, Stamp to) const;

 private:
  /// A frame as seen from a keyframe.
  struct Seen {
    Stamp keyframe;
    Pose2 keyframe_from_frame;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  [[nodiscard]] std::optional<Seen> last_seen(Stamp frame) const;
  [[nodiscard]] std::optional<Seen> seen_from(Stamp keyframe, Stamp frame) const;

  std::map<std::pair<Stamp, Stamp>, VisualOdometryIncrement> by_frames_;  ///< by (from, to)
  std::map<Stamp, Stamp> next_keyframe_;
  std::map<Stamp, Stamp> keyframe_of_;  ///< the latest from which a frame was registered
};

}  // namespace lodestar
