#pragma once

#include <vector>

#include "planning/visibility_graph_search.hpp"

namespace lodestar {

/// The fastest path that the limits' work finds, from a clear one: rounds of a search over turn points, each
/// round over others and below the cost of the best path so far, whose paths are then refined.
TurnPath fastest_path(std::vector<Vec2> known, const EndHeadings& headings, const CollisionChecker& space,
                      const PathCost& cost, VisibilityGraphSearch& turns, const TurnSearchLimits& limits);

}  // namespace lodestar
