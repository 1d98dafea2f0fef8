#pragma once

#include <vector>

#include "planning/path_cost.hpp"
#include "planning/turn_search_limits.hpp"

namespace lodestar {

enum class Refinement {
  quick,   ///< turns alone, with steps down to 0.3 cells
  coarse,  ///< turns and legs, to 0.3 cells
  fine     ///< to 0.01 cells
};

/// The same path, clear, with its turns left out, merged and moved where that costs less: a pattern search
/// (Hooke and Jeeves 1961) for turns and for legs, from steps of a radius down. Start and goal stay. Points
/// in grid coordinates; `points` must be clear.
CountedPath refined(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
                    const PathCost& cost, Refinement refinement);

}  // namespace lodestar
