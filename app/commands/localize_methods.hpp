#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/frames/frame_source.hpp"
#include "app/site/site.hpp"
#include "localization/detection/detected_marker.hpp"
#include "localization/pose/pose_fix.hpp"

// From a frame to a row of `localize`, by our method or by the paper's.
namespace lodestar {

struct LocalizeSigmas {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;
};

/// The camera's pose in the map, or the robot's when its mount is known.
struct LocalizeRow {
  std::string file;
  Stamp stamp;
  std::vector<int> ids;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::optional<LocalizeSigmas> sigmas;  ///< nothing where the method does not tell
  double confidence = 0.0;
  int dots = 0;
};

/// What one frame gives.
struct LocatedFrame {
  std::span<const DetectedMarker> markers;  ///< until the next frame
  std::optional<LocalizeRow> row;
};

class FrameLocalizer {
 public:
  virtual ~FrameLocalizer() = default;
  virtual LocatedFrame locate(const SourceFrame& frame) = 0;

  /// Why a marker is not used that is registered once, when others gave a pose.
  [[nodiscard]] virtual std::string why_not_used() const = 0;
};

/// All dots of all markers and the prior; with `track`, markers are looked for first where the last pose has
/// them.
std::unique_ptr<FrameLocalizer> default_localizer(const MarkerRegistry& registry, const CameraModel& camera,
                                                  const std::optional<Robot>& robot,
                                                  const PoseFixOptions& options, bool track);

/// The paper's whole method: its detection, P3P on the optimal marker's O, X and Y, and Eq. (17).
std::unique_ptr<FrameLocalizer> paper_localizer(const MarkerRegistry& registry, const CameraModel& camera,
                                                const std::optional<Robot>& robot);

}  // namespace lodestar
