#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "localization/detected_marker.hpp"
#include "localization/dots.hpp"
#include "localization/marker_areas.hpp"
#include "localization/marker_decoder.hpp"

// The paper's own way from a frame to decoded markers (sections 4.1 and 4.2), step by step.
namespace lodestar {

struct PaperDetectorOptions {
  DotOptions dots;
  MarkerAreaOptions areas;
  MarkerDecoderOptions decoder;
  /// A cell without a dot must be darker than this share of the dots' contrast: a dot that the threshold lost
  /// would change the ID.
  double empty_cell_contrast = 0.35;
};

/// Every marker that could be decoded, the optimal one (nearest to the image centre, Eq. (1)) first. A marker
/// of which any cell, empty or not, is cut by the frame's border is refused. `gray` is CV_8UC1, of any size,
/// and may be a part of a larger frame; any other type throws std::invalid_argument.
std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const PaperDetectorOptions& options = {});

}  // namespace lodestar
