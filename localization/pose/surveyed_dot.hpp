#pragma once

#include "maps/geometry.hpp"

namespace lodestar {

/// A dot of known position on the ceiling.
struct SurveyedDot {
  Vec3 point_in_map = Vec3::Zero();
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.03;        ///< standard deviation of each coordinate of the centre
  double shared_sigma_px = 0.0;  ///< the part of it common to all frames: the dot's displacement
};

}  // namespace lodestar
