#pragma once

#include <vector>

#include "drivers/simulation/light_image.hpp"
#include "drivers/simulation/vignetting.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// A flat square with a printed pattern of even modules: the paper of a square tag, a cover, a patch of sun.
/// Paper scatters light to all sides: its gray does not depend on the distance, as that of film does.
struct PrintedSquare {
  /// Origin in the middle, x to the right and y upwards on the printed face, z out of the face.
  Eigen::Isometry3d map_from_square = Eigen::Isometry3d::Identity();
  double side_m = 0.0;
  int modules = 1;           ///< along a side
  std::vector<double> gray;  ///< of each module, row by row from the top; on the axis, before noise
};

/// Lays the square, blurred, over the picture: a pattern is sampled several times a pixel, blurred by the
/// same Gaussian as all else, and read at the pixels' centres. Nothing when it is behind the camera or shows
/// its back.
void paint_square(const PrintedSquare& square, const Eigen::Isometry3d& camera_from_map,
                  const CameraModel& camera, const Vignetting& vignetting, double sigma_px,
                  LightImage& image);

}  // namespace lodestar
