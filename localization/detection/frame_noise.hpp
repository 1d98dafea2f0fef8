#pragma once

#include <opencv2/core/mat.hpp>

namespace lodestar {

/// Standard deviation of a pixel's noise in the dark, in gray values, from a few differences of neighbouring
/// pixels all over the frame. What the ceiling shows is left out: dots and lamps, and lines in one direction.
/// `gray` is CV_8UC1.
double noise_of(const cv::Mat& gray);

}  // namespace lodestar
