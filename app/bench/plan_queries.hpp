#pragma once

#include <cstdint>
#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

struct PlanQuery {
  Vec2 start_m;
  Vec2 goal_m;
};

/// Random clear points in the same connected region, at least this far apart; fewer where they are hard to
/// find.
std::vector<PlanQuery> random_queries(const CollisionChecker& space, int count, double least_distance_m,
                                      std::uint64_t seed);

}  // namespace lodestar
