#pragma once

#include <vector>

#include "planning/path_cost.hpp"

namespace lodestar {

/// The points of a path at which a leg may begin or end: the turns, and some between them on long straights.
std::vector<Vec2> leg_ends(const std::vector<Vec2>& points);

/// Few straight legs instead of many small steps: the cheapest chain of clear legs over the given points,
/// which keeps their first and last. A turn costs as much as `turn_cost_m` of way. Points in grid
/// coordinates.
std::vector<Vec2> shortened(const std::vector<Vec2>& points, const CollisionChecker& space,
                            const PathCost& cost, double turn_cost_m);

}  // namespace lodestar
