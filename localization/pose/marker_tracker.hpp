#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/marker_detector.hpp"
#include "localization/pose/expected_view.hpp"
#include "maps/camera_model.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

struct MarkerTrackerOptions {
  /// Every Nth frame is searched in full, so that an unexpected marker (moved, or new) is found by then.
  int full_search_every = 10;
  double sigmas = 4.0;         ///< of the expected view's error: search range around a marker's place
  double margin_px = 4.0;      ///< added to it
  double most_of_frame = 0.5;  ///< above this share of the frame, all of it is searched
};

/// Reads the markers of frame after frame, first where the expected view predicts the registered ones.
/// Searches the whole frame when nothing is predicted or found, every Nth frame, and at once when a marker
/// that must be in view is not read, unless the last full search missed it too. In the predicted places it
/// finds what a full search finds. Reuses its buffers.
class MarkerTracker {
 public:
  MarkerTracker(const MarkerRegistry& registry, const CameraModel& camera,
                const DetectorOptions& detector = {}, const MarkerTrackerOptions& options = {});

  /// Goes by these markers from now on.
  void use_registry(const MarkerRegistry& registry);

  /// As MarkerDetector::detect().
  std::span<const DetectedMarker> detect(const cv::Mat& gray, const std::optional<ExpectedView>& expected);

  /// True when the last frame was searched in full.
  [[nodiscard]] bool searched_all() const { return frames_since_full_search_ == 0; }

 private:
  struct MarkerInMap {
    int id = 0;
    Eigen::Isometry3d map_from_marker;
  };

  void expect(const ExpectedView& view);
  [[nodiscard]] bool covers_too_much() const;
  [[nodiscard]] bool lacks_any(std::span<const DetectedMarker> found) const;
  std::span<const DetectedMarker> search_all(const cv::Mat& gray);

  std::vector<MarkerInMap> markers_in_map_;
  CameraModel camera_;
  MarkerTrackerOptions options_;
  DetectorOptions detector_options_;
  MarkerDetector detector_;
  std::vector<cv::Rect> parts_;    ///< of the frame, around predicted markers
  std::vector<int> must_be_seen_;  ///< IDs, by the expected view
  std::vector<int> not_seen_;      ///< of those, the ones that the last full search missed
  int frames_since_full_search_ = 0;
};

}  // namespace lodestar
