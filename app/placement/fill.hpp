#pragma once

#include <vector>

#include "app/placement/coverage.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

struct FillOptions {
  double ceiling_m = 2.6;  ///< height of the new markers
  int wanted = 2;          ///< markers in view wherever the robot can be, at every heading
  double spacing_m = 0.3;  ///< between places that are considered, as in the page's Fill
  double sample_m = 0.15;  ///< between positions of the robot that are considered
  double apart_m = 0.5;    ///< between markers, centre to centre: sheets must not touch
};

struct Filling {
  std::vector<RegisteredMarker> added;  ///< in the registry's frame, in the order of their gain
  /// Floor that no place on the ceiling can cover so often.
  double uncovered_m2 = 0.0;
};

/// Places and IDs for markers that the registry lacks, by the greedy algorithm for set cover (Chvatal 1979).
/// Their yaw is that of the map's x axis. IDs are as far apart from each other and from those present as so
/// many can be. Throws InputError when the IDs do not suffice, or when the ceiling is not above the camera.
Filling fill_gaps(const MarkerRegistry& registry, const CoveredFloor& floor, const FillOptions& options);

}  // namespace lodestar
