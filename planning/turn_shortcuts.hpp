#pragma once

#include <vector>

#include "planning/path_cost.hpp"
#include "planning/turn_search_limits.hpp"

namespace lodestar {

/// The same path, clear, with all between two of its points replaced by one turn where that costs less: from
/// both points rays run in all directions as far as they are clear, and the new turn is where two of them
/// meet. Unlike merging (turn_merging.hpp), which looks near the present legs, it finds other, straighter
/// ways. Points in grid coordinates; `points` must be clear. For paths whose turns count and whose cells do
/// not.
CountedPath with_shortcuts(std::vector<Vec2> points, const EndHeadings& headings,
                           const CollisionChecker& space, const PathCost& cost);

}  // namespace lodestar
