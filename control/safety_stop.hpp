#pragma once

#include <optional>
#include <string_view>

#include "maps/motion.hpp"

namespace lodestar {

struct SafetyStopOptions {
  /// Longest time without a frame that confirms the estimate, by a marker or the ceiling's own motion. A
  /// backstop behind the covariance limits, for an overconfident estimate.
  Duration max_time_unseen = std::chrono::seconds(20);
  Duration max_travel_age =
      std::chrono::milliseconds(100);  ///< wheel travel older than this: the base is silent
  double max_position_sigma_m = 0.10;  ///< limit of the larger principal standard deviation
  double max_heading_sigma_rad = radians(5.0);
};

enum class StopReason {
  no_pose,
  pose_stale,
  pose_uncertain,
  base_silent,
  way_blocked,
  person_near,     ///< the protective field: someone could be here before the robot is at rest
  obstacle_ahead,  ///< likewise: something that the map lacks
  hidden_corner,   ///< likewise: someone could step out
  scanner_silent,
  scanner_clock,
  scanner_late,
  scanner_repeats,
  scanner_damaged,
  scanner_motor,
  scanner_dirty,
  scanner_blind,
  scanner_turned,
  depth_silent,      ///< no image of the depth camera
  map_contradicted,  ///< beams pass through walls of the map
  camera_silent,
  camera_repeats,
  camera_dark,
  camera_bright,
  camera_late,
  camera_clock,
  contradicted,
  pose_moved,
  wheels_wrong,
  carried_away,   ///< latched
  wheels_broken,  ///< latched
};
std::string_view to_string(StopReason reason);

/// A latched stop does not end by itself: a person must check the robot and restart it.
bool is_latched(StopReason reason);

/// Does the robot wait for others to make room, by its protective field?
bool waits_for_others(StopReason reason);

/// Would a marker in view end the stop?
bool can_a_marker_end(StopReason reason);

/// Why the robot must not move now, by the age and the uncertainty of its estimate; nothing when it may.
std::optional<StopReason> reason_to_stop(Stamp now, const std::optional<PoseEstimate>& estimate,
                                         const SafetyStopOptions& options);

}  // namespace lodestar
