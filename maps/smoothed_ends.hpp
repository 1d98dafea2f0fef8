#pragma once

#include <vector>

#include "maps/scan_rays.hpp"

namespace lodestar {

struct SmoothingOptions {
  int neighbours = 2;     ///< on each side: five beams leave half the noise of the range
  double joins_m = 0.05;  ///< from each to the next, or the surface ends there
};

/// The end of each ray, in their frame: where surfaces are hit, the mean with its neighbours on the same
/// surface. Half a degree apart, five beams span 2 cm at half a metre, over which a leg's curve is a
/// millimetre.
std::vector<Vec2> smoothed_ends_m(const DeskewedScan& scan, const SmoothingOptions& options = {});

}  // namespace lodestar
