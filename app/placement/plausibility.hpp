#pragma once

#include <vector>

#include "app/placement/coverage.hpp"

namespace lodestar {

/// Numbers of markers that cannot be right, or hardly: heights below what the camera can see (an error), far
/// from those of the markers around or beyond any ceiling, and places inside what is built. What a marker on
/// a cupboard shares with one in a wall is that the map cannot tell them apart: without heights only what
/// lies deep inside is named.
std::vector<RegistryIssue> find_implausible(const MarkerRegistry& registry, const CoveredFloor& floor);

}  // namespace lodestar
