#pragma once

#include "localization/detection/inline_vector.hpp"
#include "maps/geometry.hpp"
#include "maps/marker.hpp"

namespace lodestar {

/// One dot of a decoded marker: which cell of the grid, and where its centre is in the image (pixel centres
/// have integer coordinates).
struct MarkerDot {
  GridCell cell;
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.0;  ///< standard deviation of each coordinate; 0: not known
};

/// At most one for each cell; without memory of their own, so that reading a frame takes none.
using MarkerDots = InlineVector<MarkerDot, marker_grid_size * marker_grid_size>;

/// A marker that was seen and decoded.
struct DetectedMarker {
  int id = 0;
  double probability = 0.0;  ///< that the ID is right, by the evidence of all cells; 0: they were not weighed
  double confidence = 0.0;   ///< P(S) of Eq. (3)
  Vec2 center_px =
      Vec2::Zero();  ///< centre of the marker's area, whose distance to the image centre ranks it
  Vec2 o_px = Vec2::Zero();
  Vec2 x_px = Vec2::Zero();
  Vec2 y_px = Vec2::Zero();
  MarkerDots dots;  ///< those that were seen; O, X and Y among them as a rule
};

}  // namespace lodestar
