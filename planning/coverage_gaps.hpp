#pragma once

#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/coverage_lanes.hpp"

namespace lodestar {

/// Lanes through what `lanes` leave out of `floor` (row by row, the cells of the map that are to be covered):
/// cells from which no point of a lane within `reach_m` can be reached in a straight line. Each goes through
/// the middle of a gap, along a row or a column, and may be a single place.
std::vector<Lane> lanes_through_gaps(const CollisionChecker& roomy, const std::vector<bool>& floor,
                                     const std::vector<Lane>& lanes, double reach_m);

}  // namespace lodestar
