#pragma once

#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The floor that the markers of a site are to cover, for its default camera and its robot: wherever the
/// robot can be, and the usual routes from the start to each goal in turn. Legs that cannot be planned are
/// omitted. Throws InputError for an OctoMap that cannot be read.
CoveredFloor covered_floor(const Site& site);

}  // namespace lodestar
