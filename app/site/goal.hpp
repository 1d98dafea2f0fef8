#pragma once

#include <optional>
#include <string>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Of a coordinate in the map: no indoor site is this large; a larger number is a mistake of units.
inline constexpr double far_m = 1e5;

/// A position to drive to, with an optional final heading.
struct Goal {
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
  /// A point on the way: the robot neither settles there nor turns to a heading, and goes on without a stop
  /// where the way goes on straight.
  bool passes = false;
  /// The speed limit on the way to it, from the goal before; nothing: the robot's own.
  std::optional<double> max_mps = std::nullopt;
  /// The way to it is the straight line from the goal before; where that is not clear, the goal fails.
  bool on_line = false;
  Duration wait{};     ///< to stand there before it counts as reached
  std::string action;  ///< to be carried out there before; empty: none. See StopActions
};

}  // namespace lodestar
