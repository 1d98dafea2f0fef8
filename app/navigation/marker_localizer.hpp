#pragma once

#include <optional>
#include <vector>

#include "control/safety_stop.hpp"
#include "localization/ceiling/ceiling_motion.hpp"
#include "localization/filter/pose_filter.hpp"
#include "localization/integrity/camera_watch.hpp"
#include "localization/integrity/integrity_monitor.hpp"
#include "localization/integrity/marker_trust.hpp"
#include "localization/pose/marker_tracker.hpp"
#include "localization/pose/pose_fixer.hpp"
#include "maps/frame.hpp"

namespace lodestar {

/// One camera frame that gave a pose, and what the filter made of it.
struct FixAttempt {
  PoseFix fix;
  PlanarFix planar;
  std::optional<Pose2> expected;  ///< where the estimate had the robot
  FixOutcome outcome = FixOutcome::collecting;
};

/// What the robot holds true about where it is, which markers tell the truth, and whether its camera and
/// wheels do.
struct LocalizationState {
  PoseFilter filter;
  MarkerTrust trust;
  CameraWatch camera;
  IntegrityMonitor integrity;

  void add_travel(const WheelTravel& reading);
};

/// Why the robot must not move now, nothing when it may: `reason`, found elsewhere, in clearer words where
/// the camera is the cause; or else what is doubtful about the estimate.
std::optional<StopReason> with_doubts(const std::optional<StopReason>& reason, const LocalizationState& known,
                                      Stamp now);

/// From a camera frame to a better belief: reads the markers, first where the belief says that they must be,
/// takes the pose from those that are trusted, and calls a marker to account that contradicts the others or
/// the estimate. How the ceiling itself moves tells how the robot does, where no marker hangs too.
class MarkerLocalizer {
 public:
  MarkerLocalizer(const MarkerRegistry& registry, const CameraModel& camera,
                  const Eigen::Isometry3d& base_from_camera, const DetectorOptions& detector,
                  const PoseFixOptions& fix, const PoseFilterOptions& filter);

  /// A frame that has arrived now. Nothing when no pose came of it; the belief may know more of its markers
  /// even so. Where the wheels turn out to have been wrong, the belief begins anew.
  std::optional<FixAttempt> see(const Frame& frame, Stamp now, LocalizationState& known);

 private:
  [[nodiscard]] std::optional<ExpectedView> view_expected_at(Stamp stamp,
                                                             const LocalizationState& known) const;
  [[nodiscard]] std::optional<FixAttempt> fix_by(const Frame& frame, std::span<const DetectedMarker> markers);
  [[nodiscard]] std::vector<FixAttempt> fixes_by_each(const Frame& frame,
                                                      std::span<const DetectedMarker> markers);
  void follow_ceiling(const Frame& frame, LocalizationState& known);
  std::optional<FixAttempt> look(const Frame& frame, LocalizationState& known);
  void judge(const FixAttempt& single, LocalizationState& known) const;

  MarkerRegistry registry_;
  Eigen::Isometry3d base_from_camera_;
  PoseFixOptions fix_options_;
  MarkerTracker tracker_;
  PoseFixer fixer_;
  std::optional<CeilingMotion> ceiling_;  ///< where all markers hang on one, and the sway is known
  PoseFilterOptions filter_options_;
};

}  // namespace lodestar
