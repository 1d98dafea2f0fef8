#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// What goes wrong in one mission of a campaign: most often one fault, sometimes none, two or three, of all
/// kinds, from the start on or while it drives. The same seed gives the same faults.
std::vector<Fault> random_faults(std::uint64_t seed);

}  // namespace lodestar
