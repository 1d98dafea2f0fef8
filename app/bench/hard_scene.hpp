#pragma once

#include "app/bench/scene.hpp"

namespace lodestar {

enum class HardFrames {
  /// Several markers with any IDs, in light from good to poor, blurred or sharp, among tubes, lamps, glints
  /// and patches of sun, from 1.5 to 4 m, tilted by up to 10 degrees; half of them with a sheet that may
  /// occlude a marker.
  adverse,
  /// The same without any marker, though the detector expects some, under any kind of ceiling.
  empty,
  /// One marker whose O, X or Y is occluded wholly or in part, or cut by the image border.
  direction_dot_lost,
};

/// A ceiling and its light, for a batch of hard frames.
struct HardScene {
  MarkerRegistry registry;  ///< what the detector expects
  bool markers_hang = true;
  SimulatedCameraOptions light;
  std::vector<PrintedSquare> sun;
  double ceiling_m = 2.6;  ///< above the camera
  double reach_m = 1.5;    ///< the camera looks within this distance of the origin, along x and y
};

/// Markers on a square grid about the origin, with random distinct IDs, shifts and yaws.
MarkerRegistry some_markers(int aside, double spacing_m, double ceiling_m, Random& random);

HardScene some_hard_scene(HardFrames kind, Random& random);

/// A random view of it: map_from_camera and covers.
/// A camera at this depth below a random place within reach, tilted by up to 10 degrees.
BenchView some_tilted_view(const HardScene& scene, Random& random);

BenchView some_hard_view(HardFrames kind, const HardScene& scene, Random& random);

}  // namespace lodestar
