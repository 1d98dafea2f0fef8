#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/site/site.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Up to three boxes and chairs that the map of the site lacks; half of them are pushed there as the robot
/// sets off. Around them all a way from start to goal remains. The same seed gives the same things.
std::vector<MovingDisc> random_things(const Site& site, std::uint64_t seed);

/// From the site's start to its first goal on this map; nothing where there is none.
std::optional<Path> way_of(const Site& site, const OccupancyMap& map);

/// The map with the things, where they come to stand, and the room that the robot keeps around each.
OccupancyMap with_things(OccupancyMap map, std::span<const MovingDisc> things);

}  // namespace lodestar
