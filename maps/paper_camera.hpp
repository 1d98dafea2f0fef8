#pragma once

#include "maps/camera_model.hpp"

namespace lodestar {

/// K of Eq. (16); the paper gives no distortion. It sees 45.9 x 35.3 degrees, not the 90 degrees of the
/// paper's navigation experiment, which therefore has a wide camera of its own (sites/lab/camera.yaml).
inline CameraModel paper_camera() {
  return {.width_px = 640,
          .height_px = 480,
          .fx_px = 755.139,
          .fy_px = 753.926,
          .cx_px = 320.252,
          .cy_px = 239.661};
}

}  // namespace lodestar
