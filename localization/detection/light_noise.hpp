#pragma once

#include <opencv2/core/mat.hpp>

#include "maps/geometry.hpp"

namespace lodestar {

/// Shot noise of a pixel: its variance is proportional to the gray value above the dark level. A property of
/// the camera, learned from dot after dot, frame after frame, from an initial assumption.
///
/// The centre of a large dot is flat. For the four pixels around it the difference a - b - c + d cancels a
/// slope and a round dome; the rest has four times a pixel's variance. It also cancels any other round shape
/// whose centre is midway between columns or midway between rows, where the four are equal in pairs: so small
/// dots in such positions measure noise too.
class LightNoise {
 public:
  /// `shot_noise_gray_at_255`: initial standard deviation at gray 255.
  explicit LightNoise(double shot_noise_gray_at_255);

  /// Adds the centre of a dot, in a frame of known dark noise. `is_flat`: its edge is far from the centre.
  void add(const cv::Mat& gray, const Vec2& center_px, bool is_flat, double background_gray,
           double dark_noise_gray);

  /// Variance per gray value above the background.
  [[nodiscard]] double variance_per_gray() const;

 private:
  double variance_sum_;  ///< in excess of the dark noise's
  double light_sum_;     ///< above the background
};

}  // namespace lodestar
