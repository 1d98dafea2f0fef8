#pragma once

#include <cstddef>
#include <vector>

#include "planning/path_cost.hpp"

namespace lodestar {

enum class Refinement {
  quick,   ///< turns alone, with steps down to 0.3 cells
  coarse,  ///< turns and legs, to 0.3 cells
  fine     ///< to 0.01 cells
};

struct RefinedPath {
  std::vector<Vec2> points;
  std::size_t work = 0;  ///< as TurnSearchLimits count it
};

/// The same path, clear, with its turns left out, merged and moved where that costs less: a pattern search
/// (Hooke and Jeeves 1961) for turns and for legs, from steps of a radius down. Start and goal stay. Points
/// in grid coordinates; `points` must be clear.
RefinedPath refined(std::vector<Vec2> points, const EndHeadings& headings, const CollisionChecker& space,
                    const PathCost& cost, Refinement refinement);

}  // namespace lodestar
