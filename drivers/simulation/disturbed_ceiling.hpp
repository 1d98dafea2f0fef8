#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/ceiling.hpp"
#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// The markers as they hang while these faults are on.
MarkerRegistry disturbed(const MarkerRegistry& registry, const std::vector<Fault>& active);

/// The lamps that these faults put around markers. Deterministic in the seed.
std::vector<CeilingDisc> decoy_lamps(const MarkerRegistry& registry, const std::vector<Fault>& active,
                                     std::uint64_t seed);

}  // namespace lodestar
