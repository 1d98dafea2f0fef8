#pragma once

#include <string>
#include <vector>

#include "app/site/site.hpp"

namespace lodestar {

/// Where robots begin in one site: the first at its start, the others at places nearest to it by driving,
/// where they have room, see a marker whichever way they look and are `apart_m` from each other, all with the
/// start's heading. Throws InputError where the site does not have room for so many.
std::vector<Pose2> fleet_starts(const Site& site, const std::string& camera, int robots, double apart_m);

}  // namespace lodestar
