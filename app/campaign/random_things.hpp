#pragma once

#include <cstdint>
#include <vector>

#include "app/site/site.hpp"
#include "drivers/simulation/moving_disc.hpp"

namespace lodestar {

/// Up to three boxes and chairs that the map of the site lacks; half of them are pushed there as the robot
/// sets off. Around them all a way from start to goal remains. The same seed gives the same things.
std::vector<MovingDisc> random_things(const Site& site, std::uint64_t seed);

}  // namespace lodestar
