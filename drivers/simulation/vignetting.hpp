#pragma once

#include "maps/camera_model.hpp"

namespace lodestar {

/// How the light of the infrared ring and the lens falls off from the image's middle to its corners.
class Vignetting {
 public:
  Vignetting(const CameraModel& camera, double loss_in_corners)
      : middle_px_(0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1)),
        loss_per_px2_(loss_in_corners / middle_px_.squaredNorm()) {}

  /// Share of the light on the axis that is left at a pixel.
  [[nodiscard]] double at(const Vec2& pixel) const {
    const double left = 1.0 - loss_per_px2_ * (pixel - middle_px_).squaredNorm();
    return left > 0.0 ? left : 0.0;
  }

 private:
  Vec2 middle_px_;
  double loss_per_px2_;
};

}  // namespace lodestar
