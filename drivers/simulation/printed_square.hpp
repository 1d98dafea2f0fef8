#pragma once

#include <vector>

#include "drivers/simulation/light_image.hpp"
#include "drivers/simulation/vignetting.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// A flat square with a printed pattern of equal modules: a square tag, a cover, a patch of sunlight. Paper
/// scatters diffusely: unlike that of film, its gray value does not depend on the distance.
struct PrintedSquare {
  /// Origin at the centre, x to the right and y upwards on the printed face, z out of the face.
  Eigen::Isometry3d map_from_square = Eigen::Isometry3d::Identity();
  double side_m = 0.0;
  int modules = 1;           ///< along a side
  std::vector<double> gray;  ///< per module, row by row from the top; on the optical axis, before noise
};

/// Draws the blurred square: a pattern is supersampled, blurred by the same Gaussian as everything else, and
/// evaluated at the pixel centres. Draws nothing when the square is behind the camera or seen from the back.
void paint_square(const PrintedSquare& square, const Eigen::Isometry3d& camera_from_map,
                  const CameraModel& camera, const Vignetting& vignetting, double sigma_px,
                  LightImage& image);

}  // namespace lodestar
