#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/random.hpp"

// Noise on a square whose opposite sides join, for textures that repeat.
namespace lodestar {

/// Independent normal numbers (size x size).
cv::Mat1f white_noise(int size, Random random);

/// Gaussian blur across joined sides, by sigmas in texels along x and y.
cv::Mat1f blurred_periodically(const cv::Mat1f& image, double sigma_x, double sigma_y);

/// White noise after that blur, scaled to mean 0 and standard deviation 1.
cv::Mat1f smooth_noise(int size, double sigma_x, double sigma_y, Random random);

}  // namespace lodestar
