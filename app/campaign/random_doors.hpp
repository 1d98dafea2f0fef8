#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/site/site.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/sliding_door.hpp"

namespace lodestar {

/// Where the way from start to goal leads through a gap as wide as a door.
struct Doorway {
  Vec2 from_m = Vec2::Zero();  ///< on the map, at one post
  Vec2 to_m = Vec2::Zero();    ///< at the other
};

/// The doorways of a site's way, in its order; gaps of 0.8 to 1.6 m between posts.
std::vector<Doorway> doorways_of(const Site& site);

/// In half of the worlds that have a doorway, one that slides shut in front of the robot, or behind it, and
/// opens again after a while; where another way remains around the things, it may stay shut. The same seed
/// gives the same door.
std::optional<SlidingDoor> random_door(const Site& site, std::span<const MovingDisc> things,
                                       std::uint64_t seed);

}  // namespace lodestar
