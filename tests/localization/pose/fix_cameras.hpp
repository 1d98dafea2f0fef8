#pragma once

#include <optional>

#include "localization/pose/pose_fix.hpp"
#include "maps/camera_model.hpp"

// A second camera, besides the paper's, for tests of fixes, and how well its tilt is known.
namespace lodestar::testing {

inline CameraModel wide_camera() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 320.0;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.06, 0.01, 0.0004, -0.0003};
  return camera;
}

inline PoseFixOptions with_tilt_sigma(std::optional<double> tilt_sigma_rad, double dot_sigma_px) {
  PoseFixOptions options;
  options.prior.tilt_sigma_rad = tilt_sigma_rad;
  options.dot_sigma_px = dot_sigma_px;
  return options;
}

}  // namespace lodestar::testing
