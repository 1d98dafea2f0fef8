#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/ceiling.hpp"
#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// The markers on the ceiling while these faults are active.
MarkerRegistry disturbed(const MarkerRegistry& registry, const std::vector<Fault>& active);

/// The decoy lamps that these faults place around markers. Deterministic in the seed.
std::vector<CeilingDisc> decoy_lamps(const MarkerRegistry& registry, const std::vector<Fault>& active,
                                     std::uint64_t seed);

}  // namespace lodestar
