#pragma once

#include <vector>

#include "planning/path_cost.hpp"

namespace lodestar {

/// Candidate ends of legs: the turns of a path, and points on long straights between them.
std::vector<Vec2> leg_ends(const std::vector<Vec2>& points);

/// String pulling: each leg goes as far along the points as it is clear.
std::vector<Vec2> pulled_tight(const std::vector<Vec2>& points, const CollisionChecker& space);

/// Few straight legs instead of many small steps: the cheapest chain of clear legs over the given points,
/// which keeps their first and last. A turn costs as much as `turn_cost_m` of length. Points in grid
/// coordinates.
std::vector<Vec2> shortened(const std::vector<Vec2>& points, const CollisionChecker& space,
                            const PathCost& cost, double turn_cost_m);

}  // namespace lodestar
