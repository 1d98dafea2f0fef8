#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/stamp.hpp"

namespace lodestar {

/// One picture of the ceiling: 8-bit gray (CV_8UC1), stamped with the middle of its exposure, not its
/// arrival.
struct Frame {
  Stamp stamp;
  cv::Mat gray;
};

}  // namespace lodestar
