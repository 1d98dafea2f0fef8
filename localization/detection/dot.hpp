#pragma once

#include <cstddef>

#include "maps/geometry.hpp"

namespace lodestar {

/// One bright dot of a frame.
struct Dot {
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.0;         ///< standard deviation of each coordinate
  double radius_px = 0.0;        ///< of a uniform disc with the same total light; independent of blur
  double background_gray = 0.0;  ///< around the dot
  double contrast_gray = 0.0;    ///< centre minus background
  bool on_structure = false;     ///< the ceiling around it is uneven, which makes the radius less accurate
  std::size_t area = 0;          ///< index of its bright area
};

}  // namespace lodestar
