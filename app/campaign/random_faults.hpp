#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// Do markers tell another pose than the true one, while nothing on them shows it?
bool misleads(FaultKind kind);

/// The faults of one campaign mission: most often one, sometimes none, two or three, of all kinds, from the
/// start or during the drive; those of a scanner where the robot has one. The same seed gives the same
/// faults.
std::vector<Fault> random_faults(std::uint64_t seed, bool has_scanner);

}  // namespace lodestar
