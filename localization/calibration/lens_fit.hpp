#pragma once

#include <optional>
#include <span>
#include <vector>

#include "localization/calibration/calibration_board.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

enum class LensModel {
  pinhole,   ///< k1 k2 p1 p2 k3: Distortion::plumb_bob
  rational,  ///< k1 k2 p1 p2 k3 k4 k5 k6: Distortion::rational_polynomial
  fisheye    ///< k1 k2 k3 k4 of the angle to the axis: Distortion::equidistant
};

/// Standard deviations of a camera's intrinsics, in the order of CameraModel. Infinite where the images do
/// not determine them.
struct IntrinsicSigmas {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 8> coefficients{};
};

/// The camera, and the boards' orientations.
struct LensFit {
  CameraModel camera;
  IntrinsicSigmas sigmas;
  std::vector<Vec3> board_normals;  ///< of each view, in the camera frame
  std::vector<double> rms_px;       ///< of each view: root mean square reprojection error
  double all_rms_px = 0.0;          ///< over the corners of all views
};

/// Zhang's method (A flexible new technique for camera calibration, PAMI 2000): homographies give an initial
/// camera, then the sum of squared reprojection errors is minimized over intrinsics, distortion and the poses
/// of all boards; for the fisheye model, Kannala and Brandt's (2006). By OpenCV. The standard deviations are
/// those of the normal equations with the boards' poses eliminated. Nothing when there is no solution.
std::optional<LensFit> fit_lens(std::span<const BoardView> views, int width_px, int height_px,
                                LensModel model);

}  // namespace lodestar
