#pragma once

#include <vector>

#include "planning/path_cost.hpp"

namespace lodestar {

enum class Refinement { coarse, fine };

/// The same path with its turns moved, merged or left out where that costs less and stays clear: a search
/// with shrinking steps (Hooke and Jeeves 1961) for each turn in the plane, down to a hundredth of a cell
/// (coarse: a third). Start and goal stay. Points in grid coordinates; `points` must be clear.
std::vector<Vec2> refined(std::vector<Vec2> points, const EndHeadings& headings,
                          const CollisionChecker& space, const PathCost& cost, Refinement refinement);

}  // namespace lodestar
