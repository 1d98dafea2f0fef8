#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/geometry.hpp"

namespace lodestar {

/// How much a pixel's noise grows with its light: shot noise, whose variance is in proportion to the gray
/// value above the dark. A property of the camera, so it is learned from dot after dot, frame after frame,
/// beginning with an assumption.
///
/// The middle of a large dot is flat. Of four pixels about it the difference a - b - c + d knows neither of a
/// slope nor of a round dome; what is left has four times a pixel's variance. Of any other round shape it
/// knows nothing either where the dot lies midway between the columns or midway between the rows, for there
/// the four are alike two by two: so small dots that lie so tell of noise too.
class LightNoise {
 public:
  /// `shot_noise_gray_at_255`: the standard deviation assumed at gray 255.
  explicit LightNoise(double shot_noise_gray_at_255);

  /// The middle of a dot, in a frame whose noise in the dark is known. `is_flat`: its edge is far from it.
  void add(const cv::Mat& gray, const Vec2& center_px, bool is_flat, double background_gray,
           double dark_noise_gray);

  /// Variance for each gray value above the background.
  [[nodiscard]] double variance_per_gray() const;

 private:
  double variance_sum_;  ///< above that of the dark
  double light_sum_;     ///< above the background
};

}  // namespace lodestar
