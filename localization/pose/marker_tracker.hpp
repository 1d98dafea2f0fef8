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
  /// Every so manieth frame is searched whole, so that a marker that no one expects (moved, or new) is not
  /// missed for longer.
  int full_search_every = 10;
  double sigmas = 4.0;         ///< of the expected view's error that are searched about a marker's place
  double margin_px = 4.0;      ///< and besides
  double most_of_frame = 0.5;  ///< when the expected places cover more, all is searched
};

/// Reads the markers of frame after frame, and looks first where the registered ones must be seen from about
/// where the camera is thought to be. The whole frame is searched when nothing is expected, every so often,
/// and at once when a marker is not read that must be in view, unless the last whole search did not read it
/// either. What is found is what a search of the whole frame finds in those places. Keeps its memory.
class MarkerTracker {
 public:
  MarkerTracker(const MarkerRegistry& registry, const CameraModel& camera,
                const DetectorOptions& detector = {}, const MarkerTrackerOptions& options = {});

  /// As MarkerDetector::detect().
  std::span<const DetectedMarker> detect(const cv::Mat& gray, const std::optional<ExpectedView>& expected);

  /// Was the last frame searched whole?
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
  MarkerDetector detector_;
  std::vector<cv::Rect> parts_;    ///< of the frame, where markers are expected
  std::vector<int> must_be_seen_;  ///< IDs, by the expected view
  std::vector<int> not_seen_;      ///< of those, what the last whole search did not read
  int frames_since_full_search_ = 0;
};

}  // namespace lodestar
