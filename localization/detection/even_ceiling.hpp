#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "maps/geometry.hpp"

// A dot's surroundings without the ceiling's structure.
namespace lodestar {

/// Copy of the pixels around a place in which the ceiling has one level: gradients of its light are
/// subtracted, and its dark lines are filled. Joints, grooves and slots are darker than the ceiling between
/// them; a dot covers what is behind it, so filling them takes nothing from it.
class EvenCeiling {
 public:
  /// Largest distance from the place at which pixels are copied.
  static constexpr double most_reach_px = 28.0;

  /// The ceiling's level is a plane through the pixels of a ring with this radius, without those that
  /// deviate: dark lines, neighbouring dots. `noise_gray` is the noise of a pixel in the dark. Pixels less
  /// than `least_light_gray` above the level (usually some noise below it) are set to it. False when the
  /// frame's border cuts the ring or it is larger than `most_reach_px`; there is no copy then.
  bool copy(const cv::Mat& gray, const Vec2& center_px, double ring_px, double noise_gray,
            double least_light_gray);

  /// The copy (CV_8UC1), with the place at `center_px()`.
  [[nodiscard]] cv::Mat gray() { return {side_px, side_px, CV_8UC1, pixels_.data()}; }
  [[nodiscard]] Vec2 center_px() const { return center_px_; }
  /// Position in the copy minus position in the frame.
  [[nodiscard]] Vec2 shift_px() const { return shift_px_; }
  /// The ceiling's level at the place, to which the copy is evened.
  [[nodiscard]] double background_gray() const { return background_gray_; }

 private:
  static constexpr int side_px = 64;
  std::array<std::uint8_t, static_cast<std::size_t>(side_px) * side_px> pixels_{};
  Vec2 center_px_ = Vec2::Zero();
  Vec2 shift_px_ = Vec2::Zero();
  double background_gray_ = 0.0;
};

}  // namespace lodestar
