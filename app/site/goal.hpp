#pragma once

#include <optional>

#include "maps/geometry.hpp"

namespace lodestar {

/// Of a coordinate in the map: no indoor site is this large; a larger number is a mistake of units.
inline constexpr double far_m = 1e5;

/// A position to drive to, with an optional final heading.
struct Goal {
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
};

}  // namespace lodestar
