#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/simulation/ceiling.hpp"
#include "drivers/simulation/light_image.hpp"
#include "drivers/simulation/simulated_camera_options.hpp"
#include "drivers/simulation/surface_reflectance.hpp"
#include "drivers/simulation/vignetting.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// The image of a bare ceiling with structure: its reflectance at every pixel, light of tubes and lamps
/// beside them, the ring's own reflection on glossy paint, vignetting. Motion blur is not rendered here.
class CeilingSurface {
 public:
  CeilingSurface(const CameraModel& camera, const Vignetting& vignetting,
                 const SimulatedCameraOptions& options, std::uint64_t seed);

  /// Fills the whole image.
  void paint(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera, LightImage& image);

 private:
  const SurfaceReflectance& as_imaged(double depth_m);

  SimulatedCameraOptions options_;
  double focal_px_;
  SurfaceReflectance reflectance_;
  std::optional<int> blur_level_;  ///< of `imaged_`, in steps of a quarter octave
  SurfaceReflectance imaged_;
  std::vector<Vec3> rays_;       ///< of the pixels, in the camera frame
  std::vector<double> falloff_;  ///< of the pixels
};

}  // namespace lodestar
