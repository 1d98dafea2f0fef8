#pragma once

#include <vector>

#include "maps/geometry.hpp"
#include "maps/marker.hpp"

namespace lodestar {

/// One dot of a decoded marker: which cell of the grid, and where its centre is in the image (pixel centres
/// have integer coordinates).
struct MarkerDot {
  GridCell cell;
  Vec2 center_px = Vec2::Zero();
};

/// A marker that was seen and decoded.
struct DetectedMarker {
  int id = 0;
  double confidence = 0.0;  ///< P(S) of Eq. (3)
  Vec2 center_px =
      Vec2::Zero();  ///< centre of the marker's area, whose distance to the image centre ranks it
  Vec2 o_px = Vec2::Zero();
  Vec2 x_px = Vec2::Zero();
  Vec2 y_px = Vec2::Zero();
  std::vector<MarkerDot> dots;  ///< all dots, O, X and Y among them
};

}  // namespace lodestar
