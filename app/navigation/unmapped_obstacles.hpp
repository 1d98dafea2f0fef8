#pragma once

#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// What stands about that the map lacks, as points of the map frame that a path keeps off.
struct UnmappedObstacles {
  std::vector<Vec2> roomy_m;  ///< with room around, in which the protective field does not hold the robot
  std::vector<Vec2> tight_m;  ///< with the least room in which it lets the robot creep past
  std::vector<Vec2> bare_m;   ///< what was hit alone
  /// The path that is followed has lost some of that room, but keeps what lets the robot pass.
  bool path_is_passable = false;

  [[nodiscard]] bool empty() const { return roomy_m.empty(); }
};

}  // namespace lodestar
