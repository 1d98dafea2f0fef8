#pragma once

#include <vector>

#include "localization/detection/marker_detector.hpp"

#include "tests/localization/painted_frame.hpp"

// Small frames for the detector, and the IDs that it reads in them.
namespace lodestar {

inline std::vector<int> ids_in(const cv::Mat& frame) {
  std::vector<int> result;
  for (const DetectedMarker& marker : detect_markers(frame)) result.push_back(marker.id);
  return result;
}

/// The middle part of a camera's frame, which is quicker to draw.
inline CameraModel cropped(CameraModel camera, int side_px) {
  camera.cx_px += 0.5 * (side_px - camera.width_px);
  camera.cy_px += 0.5 * (side_px - camera.height_px);
  camera.width_px = side_px;
  camera.height_px = side_px;
  return camera;
}

inline cv::Size size_of(const CameraModel& camera) {
  return {camera.width_px, camera.height_px};
}

inline int random_id(Random& random) {
  return static_cast<int>(random.below(marker_id_count));
}

}  // namespace lodestar
