#pragma once

#include <cstdint>

#include "app/simulate/simulated_drive.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// What the map does not have, for a drive from the site's start to its first goal: boxes and chairs, some of
/// them pushed there, and a sliding door. The same seed gives the same.
void add_random_obstacles(const Site& site, std::uint64_t seed, SimulatedDriveOptions& options);

}  // namespace lodestar
