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

/// A pose fix from one camera frame, and its outcome in the filter.
struct FixAttempt {
  PoseFix fix;
  PlanarFix planar;
  std::optional<Pose2> expected;  ///< by the estimate, before this fix
  FixOutcome outcome = FixOutcome::collecting;
};

/// The localization state: the belief of the pose, the trust in each marker, and the monitors of the camera
/// and of the estimate's integrity.
struct LocalizationState {
  PoseFilter filter;
  MarkerTrust trust;
  CameraWatch camera;
  IntegrityMonitor integrity;

  void add_travel(const WheelTravel& reading);
};

/// Why the robot must not move now; nothing when it may. `reason` comes from the safety stop; a camera fault
/// that causes it, or an integrity alarm, takes its place.
std::optional<StopReason> with_integrity_alarms(const std::optional<StopReason>& reason,
                                                const LocalizationState& known, Stamp now);

/// Updates the belief from camera frames: detects markers, first where the belief predicts them, fixes the
/// pose by the trusted ones, and reports markers that contradict the others or the estimate to marker trust.
/// Between markers, visual odometry on the ceiling's texture observes the motion.
class MarkerLocalizer {
 public:
  MarkerLocalizer(const MarkerRegistry& registry, const CameraModel& camera,
                  const Eigen::Isometry3d& base_from_camera, const DetectorOptions& detector,
                  const PoseFixOptions& fix, const PoseFilterOptions& filter,
                  const VarianceFactor& learned = {});

  /// Goes by these markers from now on; keeps what it has learned.
  void use_registry(const MarkerRegistry& registry);

  /// Of the camera's dots, as learned so far.
  [[nodiscard]] const VarianceFactor& variance_factor() const { return fixer_.variance_factor(); }

  /// Processes a frame that has just arrived. Nothing when it gave no pose fix; visual odometry and marker
  /// trust may have been updated even so. When wheel slip has corrupted the belief, it is restarted.
  std::optional<FixAttempt> see(const Frame& frame, Stamp now, LocalizationState& known);

 private:
  [[nodiscard]] std::optional<ExpectedView> view_expected_at(Stamp stamp,
                                                             const LocalizationState& known) const;
  [[nodiscard]] std::optional<FixAttempt> fix_by(const Frame& frame, std::span<const DetectedMarker> markers);
  [[nodiscard]] std::vector<FixAttempt> fixes_by_each(const Frame& frame,
                                                      std::span<const DetectedMarker> markers);
  std::optional<FixAttempt> contradicted_by_twins(const Frame& frame, std::span<const DetectedMarker> markers,
                                                  LocalizationState& known);
  void follow_ceiling(const Frame& frame, LocalizationState& known);
  std::optional<FixAttempt> look(const Frame& frame, LocalizationState& known);
  void judge(const FixAttempt& single, LocalizationState& known) const;

  void look_at_ceiling_of(const MarkerRegistry& registry);

  MarkerRegistry registry_;
  CameraModel camera_;
  Eigen::Isometry3d base_from_camera_;
  PoseFixOptions fix_options_;
  MarkerTracker tracker_;
  PoseFixer fixer_;
  std::optional<CeilingMotion> ceiling_;  ///< only with all markers at one height and a known tilt sigma
  PoseFilterOptions filter_options_;
};

}  // namespace lodestar
