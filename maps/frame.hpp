#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/stamp.hpp"

namespace lodestar {

/// One camera image: 8-bit gray (CV_8UC1), stamped with its mid-exposure time, not its arrival time.
struct Frame {
  Stamp stamp;
  cv::Mat gray;
};

}  // namespace lodestar
