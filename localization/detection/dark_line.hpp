#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/geometry.hpp"

namespace lodestar {

/// A disc of the image, and the ceiling around it.
struct DiscOnCeiling {
  Vec2 center_px = Vec2::Zero();
  double side_px = 0.0;  ///< of a dot: its blurred edge ends here
  double ring_px = 0.0;  ///< radius of the ring that a line through the disc enters and leaves
  double level_gray = 0.0;
  double tolerance_gray = 0.0;  ///< of gray values that are called the same
};

/// Is this dot in front of a dark line of the ceiling? It is dark where the line enters and leaves the ring,
/// and the ceiling's level is seen on both sides of the dot. A cover wide enough to hide a dot, beside it,
/// reaches beyond the ring. False where the frame cuts the ring. `gray` is CV_8UC1.
bool is_before_dark_line(const cv::Mat& gray, const DiscOnCeiling& dot);

/// Does a dark line of the ceiling run through this place, and nothing else? It is as dark and as narrow
/// there as where it enters and leaves the ring.
bool shows_dark_line(const cv::Mat& gray, const DiscOnCeiling& cell);

}  // namespace lodestar
