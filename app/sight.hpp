#pragma once

#include <optional>
#include <vector>

#include "localization/marker_tracker.hpp"
#include "localization/marker_trust.hpp"
#include "localization/pose_filter.hpp"
#include "localization/pose_fixer.hpp"
#include "maps/frame.hpp"

namespace lodestar {

/// One camera frame that gave a pose, and what the filter made of it.
struct UsedFix {
  PoseFix fix;
  PlanarFix planar;
  FixOutcome outcome = FixOutcome::collecting;
};

/// What the robot holds true about where it is and which markers tell the truth.
struct Whereabouts {
  PoseFilter filter;
  MarkerTrust trust;
};

/// From a camera frame to a better belief: reads the markers, first where the belief says that they must be,
/// takes the pose from those that are trusted, and calls a marker to account that contradicts the others or
/// the estimate.
class Sight {
 public:
  Sight(const MarkerRegistry& registry, const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
        const DetectorOptions& detector, const PoseFixOptions& fix);

  /// Nothing when no pose came of the frame; the belief may know more of its markers even so.
  std::optional<UsedFix> see(const Frame& frame, Whereabouts& known);

 private:
  [[nodiscard]] std::optional<ExpectedView> view_expected_at(Stamp stamp, const Whereabouts& known) const;
  [[nodiscard]] std::optional<UsedFix> fix_by(const Frame& frame, std::span<const DetectedMarker> markers);
  [[nodiscard]] std::vector<UsedFix> fixes_by_each(const Frame& frame,
                                                   std::span<const DetectedMarker> markers);
  void judge(const UsedFix& single, Whereabouts& known) const;

  MarkerRegistry registry_;
  Eigen::Isometry3d base_from_camera_;
  PoseFixOptions fix_options_;
  MarkerTracker tracker_;
  PoseFixer fixer_;
};

}  // namespace lodestar
