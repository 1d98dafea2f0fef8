#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "localization/detection/dot.hpp"

namespace lodestar {

/// The gray level of the ceiling over a marker, known from its dots: what surrounds a dot in view is not
/// covered. A plane in the image, or constant for few dots.
class CeilingLevel {
 public:
  explicit CeilingLevel(std::span<const Dot> dots);

  [[nodiscard]] double at(const Vec2& place_px) const;

  /// Root mean square by which the dots' backgrounds deviate from it.
  [[nodiscard]] double spread_gray() const { return spread_gray_; }

 private:
  [[nodiscard]] Vec3 row_at(const Vec2& place_px) const;

  Vec2 middle_px_ = Vec2::Zero();
  double per_px_ = 1.0;
  Vec3 plane_ = Vec3::Zero();
  double spread_gray_ = 0.0;
};

/// Share of a disc's pixels whose gray value is within the tolerance of a level.
double share_at_level(const cv::Mat& gray, const Vec2& center_px, double radius_px, double level_gray,
                      double tolerance_gray);

}  // namespace lodestar
