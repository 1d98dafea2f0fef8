#pragma once

#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// What the markers of a site are to cover: seen by its default camera, by its robot, wherever that can be,
/// and along the usual drive, from the start to each goal in turn. Legs that cannot be planned are left out.
/// Throws InputError for an OctoMap that cannot be read.
CoveredFloor covered_floor(const Site& site);

}  // namespace lodestar
