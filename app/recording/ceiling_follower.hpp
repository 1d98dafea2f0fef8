#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "app/site/site.hpp"
#include "localization/ceiling/ceiling_motion.hpp"
#include "localization/detection/detected_marker.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Visual odometry for a survey: from the first markers seen it knows how high the ceiling is, and from the
/// wheels about where a frame was taken. Needs neither a registry nor a pose.
class CeilingFollower {
 public:
  CeilingFollower(const Robot& robot, const CameraModel& camera);

  void add(const WheelTravel& reading);

  /// The frame's motion from its keyframe; nothing where there is none. Call in order of time, after the
  /// wheel readings up to the frame.
  std::optional<VisualOdometryIncrement> see(const Frame& frame, std::span<const DetectedMarker> markers);

 private:
  void measure_height(std::span<const DetectedMarker> markers);
  [[nodiscard]] std::optional<Pose2> rolled(Stamp from, Stamp to) const;

  Robot robot_;
  CameraModel camera_;
  std::vector<double> heights_m_;  ///< of markers, until they are enough
  std::optional<CeilingMotion> ceiling_;
  std::deque<WheelTravel> travel_;  ///< of the last seconds
};

}  // namespace lodestar
