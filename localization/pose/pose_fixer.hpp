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

/// A detected marker of known position on the ceiling.
struct KnownMarker {
  int id = 0;
  double confidence = 0.0;
  std::array<SurveyedDot, 3> direction_dots;  ///< O, X, Y
  std::optional<MarkerSigma> sigma;           ///< of its place in the registry
  InlineVector<SurveyedDot, MarkerDots::static_capacity> dots;
};

/// Computes the camera's pose of frame after frame and learns the dots' VarianceFactor. Allocates nothing
/// after the first frames.
class PoseFixer {
 public:
  /// `learned`: what an earlier fixer of this camera has learned.
  PoseFixer(const MarkerRegistry& registry, const CameraModel& camera, const VarianceFactor& learned = {});

  [[nodiscard]] const VarianceFactor& variance_factor() const { return variance_factor_; }

  /// Initial guesses are the pose with the prior's tilt and P3P on O, X and Y (Eq. (10)-(15)) of the optimal
  /// (first registered) marker, in the order of their cost over all dots. From them on, the maximum a
  /// posteriori estimate over all dots of all registered markers with the prior. Where the other mode of the
  /// planar ambiguity explains the dots almost as well, the covariance covers both.
  ///
  /// A marker of which the registry knows only about where it is (its sigma) says less, and what it is off by
  /// is shared by all its fixes.
  ///
  /// Rejects a displaced marker that contradicts the others, and an ID that is seen twice. Null when no
  /// registered marker is left, when two contradict each other, or when the dots agree with no pose. The
  /// result is valid until the next call.
  const PoseFix* fix(Stamp stamp, std::span<const DetectedMarker> markers, const PoseFixOptions& options);

 private:
  struct MarkerInMap {
    int id = 0;
    Eigen::Isometry3d map_from_marker;
    std::optional<MarkerSigma> sigma;
    std::optional<Vec2> learned_at_px;  ///< its dot O, when the variance factor last learned from it
  };

  [[nodiscard]] const MarkerInMap* marker_in_map(int id) const;
  [[nodiscard]] bool has_moved();
  std::optional<Vec2>& place_learned_at(int id);
  void find_known(std::span<const DetectedMarker> markers, const PoseFixOptions& options);
  void collect_dots(std::span<const KnownMarker> markers);
  std::optional<MapEstimate> best_estimate(std::span<const KnownMarker> markers,
                                           const PoseFixOptions& options);
  std::optional<Eigen::Isometry3d> level_guess_by(std::span<const KnownMarker> markers,
                                                  const PosePrior& prior);
  void reject_outlier_marker(const PoseFixOptions& options);
  void learn(const MapEstimate& estimate);
  void conclude(Stamp stamp, const MapEstimate& estimate, const PoseFixOptions& options);

  std::vector<MarkerInMap> markers_in_map_;  ///< IDs registered exactly once, sorted by ID
  CameraModel camera_;
  std::vector<KnownMarker> known_;
  std::vector<KnownMarker> others_;
  std::vector<KnownMarker> best_others_;
  std::vector<SurveyedDot> dots_;       ///< of the markers evaluated last
  std::vector<DotsOfMarker> in_doubt_;  ///< whose they are, when any marker's place is not exact
  std::vector<SurveyedDot> guess_dots_;
  VarianceFactor variance_factor_;
  PoseFix fix_;
};

}  // namespace lodestar
