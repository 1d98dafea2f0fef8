#pragma once

#include <optional>

#include "maps/geometry.hpp"

namespace lodestar {

/// A position to drive to, with an optional final heading.
struct Goal {
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
};

}  // namespace lodestar
