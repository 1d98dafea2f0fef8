#pragma once

#include "localization/detection/inline_vector.hpp"
#include "maps/geometry.hpp"
#include "maps/marker.hpp"

namespace lodestar {

/// One dot of a decoded marker: its grid cell and its centre in the image (pixel centres have integer
/// coordinates).
struct MarkerDot {
  GridCell cell;
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.0;  ///< standard deviation of each coordinate; 0: unknown
};

/// At most one per cell; stored inline, so that reading a frame allocates nothing.
using MarkerDots = InlineVector<MarkerDot, marker_grid_size * marker_grid_size>;

/// A detected and decoded marker.
struct DetectedMarker {
  int id = 0;
  double probability = 0.0;  ///< posterior of the ID from the evidence of all cells; 0: not evaluated
  double confidence = 0.0;   ///< P(S) of Eq. (3)
  /// Centre of the marker's area; its distance to the image centre ranks the markers.
  Vec2 center_px = Vec2::Zero();
  Vec2 o_px = Vec2::Zero();
  Vec2 x_px = Vec2::Zero();
  Vec2 y_px = Vec2::Zero();
  MarkerDots dots;  ///< the visible ones, usually with O, X and Y
};

}  // namespace lodestar
