#pragma once

#include <optional>
#include <string_view>

#include "maps/motion.hpp"

namespace lodestar {

struct SafetyStopOptions {
  /// Without any frame that confirms the estimate, by a marker or the ceiling's own motion. How lost the
  /// robot is its covariance tells; this is for one that believes itself sure for ever.
  Duration max_time_unseen = std::chrono::seconds(20);
  Duration max_travel_age =
      std::chrono::milliseconds(100);  ///< wheel travel older than this: the base is silent
  double max_position_sigma_m = 0.10;  ///< largest principal deviation
  double max_heading_sigma_rad = radians(5.0);
};

enum class StopReason {
  no_pose,
  pose_stale,
  pose_uncertain,
  base_silent,
  way_blocked,
  camera_silent,
  camera_repeats,
  camera_dark,
  camera_bright,
  camera_late,
  camera_clock,
  contradicted,
  pose_moved,
  wheels_wrong,
  carried_away,   ///< for good
  wheels_broken,  ///< for good
};
std::string_view to_string(StopReason reason);

/// Nothing that the robot sees later ends such a stop: somebody must look after it and start it again.
bool is_latched(StopReason reason);

/// Would a marker in view end the stop?
bool can_a_marker_end(StopReason reason);

/// Why the robot must not move now, for what it knows of itself; nothing when it may. The robot never drives
/// on a guess.
std::optional<StopReason> reason_to_stop(Stamp now, const std::optional<PoseEstimate>& estimate,
                                         const SafetyStopOptions& options);

}  // namespace lodestar
