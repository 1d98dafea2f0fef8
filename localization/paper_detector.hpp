#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "localization/detected_marker.hpp"

// The paper's own way from a frame to decoded markers (sections 4.1 and 4.2), step by step.
namespace lodestar {

struct PaperDetectorOptions {
  int threshold = 200;             ///< gray value from which a pixel is bright (Fig. 2b)
  double min_dot_area_px = 4.0;    ///< smaller bright areas are noise
  double max_dot_area_px = 400.0;  ///< larger ones are tubes and lamps
  double max_aspect_ratio = 2.5;   ///< longer ones are tubes
  int erosion_px = 3;              ///< side of the structuring element that parts dots which touch
  int dilation_px = 0;  ///< side of the one that joins a marker's dots; 0: from the dots' own spacing
  double ratio_tolerance = 0.12;               ///< how near lambda of Eq. (8) must be to 1/3, 2/3 or 1
  double angle_tolerance_rad = radians(12.0);  ///< how near alpha of Eq. (7) must be to 90 degrees
};

/// Every marker that could be decoded, the optimal one (nearest to the image centre, Eq. (1)) first.
/// `gray` is CV_8UC1.
std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const PaperDetectorOptions& options = {});

}  // namespace lodestar
