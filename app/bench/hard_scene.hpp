#pragma once

#include "app/bench/counts.hpp"
#include "app/bench/scene.hpp"

namespace lodestar {

/// A ceiling and its light, for a batch of hard frames.
struct HardScene {
  MarkerRegistry registry;
  SimulatedCameraOptions light;
  std::vector<PrintedSquare> sun;
  double ceiling_m = 2.6;  ///< above the camera
  double reach_m = 1.5;    ///< the camera looks within this distance of the origin, along x and y
};

HardScene some_hard_scene(HardFrames kind, Random& random);

/// A random view of it: map_from_camera and covers.
BenchView some_hard_view(HardFrames kind, const HardScene& scene, Random& random);

}  // namespace lodestar
