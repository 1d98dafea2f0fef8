#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/ceiling.hpp"
#include "drivers/simulation/ceiling_texture.hpp"
#include "drivers/simulation/light_image.hpp"
#include "drivers/simulation/vignetting.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// The image of the bare ceiling: texture, glow around the lights, vignetting. It has little contrast and is
/// sampled at every other pixel only; the lens model is evaluated at the nodes of a coarse grid and
/// interpolated linearly between them. Motion blur is negligible here and not rendered.
class CeilingBackground {
 public:
  CeilingBackground(const CameraModel& camera, const Vignetting& vignetting, double background_gray,
                    double texture_gray, std::uint64_t seed);

  /// Fills the whole image.
  void paint(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera, LightImage& image);

 private:
  /// A node of the coarse grid: its texture coordinates and its light.
  struct Node {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::int32_t light = 0;  ///< in a fraction of LightImage's unit, see light_bits
    std::int32_t texture = 0;
  };

  void look_at_nodes(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera);
  void sample_half_size();
  void sample_half_row(int row);
  void enlarge(LightImage& image) const;

  double background_gray_;
  double texture_gray_;
  CeilingTexture texture_;
  int half_width_;  ///< width of the half-size image
  int half_height_;
  int node_columns_;
  int half_stride_;              ///< rounded up to whole cells
  std::vector<Vec3> rays_;       ///< of the nodes, in the camera frame
  std::vector<double> falloff_;  ///< of the nodes
  std::vector<Node> nodes_;
  std::vector<std::int16_t> half_;  ///< row by row, in units of LightImage
};

}  // namespace lodestar
