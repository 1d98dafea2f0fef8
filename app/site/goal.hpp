#pragma once

#include <optional>

#include "maps/geometry.hpp"

namespace lodestar {

/// A place to drive to; the heading only when one is wanted.
struct Goal {
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
};

}  // namespace lodestar
