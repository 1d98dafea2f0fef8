#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/inline_vector.hpp"
#include "localization/pose/map_estimate.hpp"
#include "localization/pose/pose_fix.hpp"
#include "localization/pose/variance_factor.hpp"

namespace lodestar {

/// A detected marker whose place on the ceiling is known.
struct KnownMarker {
  int id = 0;
  double confidence = 0.0;
  std::array<SurveyedDot, 3> direction_dots;  ///< O, X, Y
  InlineVector<SurveyedDot, MarkerDots::static_capacity> dots;
};

/// Finds the camera's pose frame after frame and learns their VarianceFactor. Soon it takes no more memory.
class PoseFixer {
 public:
  PoseFixer(const MarkerRegistry& registry, const CameraModel& camera);

  /// P3P on the optimal (first registered) marker's O, X and Y (Eq. (10)-(15)), and the pose with the prior's
  /// tilt, are scored by all dots; from the best one on, the maximum a posteriori estimate over all dots of
  /// all registered markers with the prior. Where a mirrored view explains the dots almost as well, the
  /// covariance covers both.
  ///
  /// A marker that contradicts those which agree (it hangs elsewhere than surveyed) is left out, and so is an
  /// ID that is seen twice. Null when no registered marker is left, when two contradict each other, or when
  /// the dots agree with no pose. The result holds until the next call.
  const PoseFix* fix(Stamp stamp, std::span<const DetectedMarker> markers, const PoseFixOptions& options);

 private:
  struct MarkerInMap {
    int id = 0;
    Eigen::Isometry3d map_from_marker;
  };

  [[nodiscard]] const MarkerInMap* marker_in_map(int id) const;
  void find_known(std::span<const DetectedMarker> markers, const PoseFixOptions& options);
  std::optional<MapEstimate> best_estimate(std::span<const KnownMarker> markers,
                                           const PoseFixOptions& options);
  std::optional<Eigen::Isometry3d> level_guess_by(std::span<const KnownMarker> markers,
                                                  const PosePrior& prior);
  void reject_outlier_marker(const PoseFixOptions& options);
  void learn(const MapEstimate& estimate);
  void conclude(Stamp stamp, const MapEstimate& estimate);

  std::vector<MarkerInMap> markers_in_map_;  ///< each ID that one marker has, by ID
  CameraModel camera_;
  std::vector<KnownMarker> known_;
  std::vector<KnownMarker> others_;
  std::vector<KnownMarker> best_others_;
  std::vector<SurveyedDot> dots_;  ///< of the markers that were looked at last
  std::vector<SurveyedDot> guess_dots_;
  VarianceFactor variance_factor_;
  Vec2 learned_at_px_ = Vec2::Zero();  ///< where the first dot was in the frame that was learned from last
  PoseFix fix_;
};

}  // namespace lodestar
