#pragma once

#include <vector>

#include "planning/path_cost.hpp"
#include "planning/turn_search_limits.hpp"

namespace lodestar {

/// The same path, clear, with two or three turns in a row replaced by one where that costs less: the turns
/// before and after them send out a fan of rays, and the new turn is where two clear rays meet. A turn costs
/// a second or more, so that one saved is worth a detour. Points in grid coordinates; `points` must be clear.
///
///     before  o------.          o  after      the new turn lies where no obstacle has a
///                     \________/              corner, so no search over turn points finds it
///
CountedPath with_turns_merged(std::vector<Vec2> points, const EndHeadings& headings,
                              const CollisionChecker& space, const PathCost& cost);

}  // namespace lodestar
