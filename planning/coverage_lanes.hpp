#pragma once

#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

/// A straight stretch of free floor.
struct Lane {
  Vec2 from_m = Vec2::Zero();
  Vec2 to_m = Vec2::Zero();
};

struct CoverageLanesOptions {
  double spacing_m = 2.0;   ///< between parallel lanes
  double shortest_m = 0.8;  ///< shorter stretches are left out, but where no lane comes near
  double longest_m = 4.0;   ///< longer ones are divided
};

/// Lanes along the map's rows, and others across them along its columns, over all floor where the disc of
/// `roomy` has room and from which that of `passable` (no larger: it may go through doors) can reach
/// `start_m`. The pattern that ties a survey together best: a boustrophedon each way; and a stretch or a
/// place in each corner that it leaves out. Empty where the start has no room.
std::vector<Lane> coverage_lanes(const CollisionChecker& roomy, const CollisionChecker& passable,
                                 const Vec2& start_m, const CoverageLanesOptions& options = {});

}  // namespace lodestar
