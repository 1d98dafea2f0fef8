#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "maps/geometry.hpp"

namespace lodestar {

/// Order statistics of the gray values around a dot. Neighbouring dots may affect their upper half.
struct Surroundings {
  std::uint8_t second_darkest = 0;
  std::uint8_t third = 0;  ///< a third of the pixels are darker
  std::uint8_t median = 0;
  std::uint8_t second_brightest = 0;
};

/// From a ring of 16 pixels around the dot, clamped to the frame.
Surroundings surroundings(const cv::Mat& gray, const Vec2& center_px, double reach_px);

}  // namespace lodestar
