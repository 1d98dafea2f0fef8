#pragma once

#include "maps/camera_model.hpp"

namespace lodestar {

/// Light falloff of infrared ring and lens from the image centre to the corners.
class Vignetting {
 public:
  Vignetting(const CameraModel& camera, double loss_in_corners)
      : middle_px_(0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1)),
        loss_per_px2_(loss_in_corners / middle_px_.squaredNorm()) {}

  /// Light at a pixel relative to that on the optical axis.
  [[nodiscard]] double at(const Vec2& pixel) const {
    const double left = 1.0 - loss_per_px2_ * (pixel - middle_px_).squaredNorm();
    return left > 0.0 ? left : 0.0;
  }

 private:
  Vec2 middle_px_;
  double loss_per_px2_;
};

}  // namespace lodestar
