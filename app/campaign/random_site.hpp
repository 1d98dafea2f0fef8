#pragma once

#include <cstdint>
#include <vector>

#include "app/site/site.hpp"

namespace lodestar {

/// A random building for this robot and camera: rooms with doors and some furniture, markers about every two
/// metres above all of it, a start and one goal that can be reached. The same seed gives the same building.
/// `ids` are the markers' IDs to choose from.
Site random_site(const Site& robot_and_cameras, const std::vector<int>& ids, std::uint64_t seed);

}  // namespace lodestar
