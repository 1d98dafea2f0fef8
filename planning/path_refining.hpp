#pragma once

#include <vector>

#include "planning/path_cost.hpp"

namespace lodestar {

enum class Refinement { coarse, fine };

/// The same path, clear, with its turns removed where the direct leg is clear and costs no more, and moved or
/// merged where that costs less: a pattern search (Hooke and Jeeves 1961) for each turn, with steps down to
/// 0.01 cells (coarse: 0.3). Start and goal stay. Points in grid coordinates; `points` must be clear.
std::vector<Vec2> refined(std::vector<Vec2> points, const EndHeadings& headings,
                          const CollisionChecker& space, const PathCost& cost, Refinement refinement);

}  // namespace lodestar
