#include "drivers/simulation/periodic_noise.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lodestar {

cv::Mat1f white_noise(int size, Random random) {
  cv::Mat1f noise(size, size);
  for (float& value : noise) value = static_cast<float>(random.normal());
  return noise;
}

cv::Mat1f blurred_periodically(const cv::Mat1f& image, double sigma_x, double sigma_y) {
  const auto border = [](double sigma) { return static_cast<int>(std::ceil(4.0 * sigma)); };
  cv::Mat1f wide;
  cv::copyMakeBorder(image, wide, border(sigma_y), border(sigma_y), border(sigma_x), border(sigma_x),
                     cv::BORDER_WRAP);
  cv::GaussianBlur(wide, wide, {}, sigma_x, sigma_y);
  return wide(cv::Rect(border(sigma_x), border(sigma_y), image.cols, image.rows)).clone();
}

cv::Mat1f smooth_noise(int size, double sigma_x, double sigma_y, Random random) {
  cv::Mat1f smooth = blurred_periodically(white_noise(size, random), sigma_x, sigma_y);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(smooth, mean, deviation);
  smooth = (smooth - mean[0]) / deviation[0];
  return smooth;
}

}  // namespace lodestar
