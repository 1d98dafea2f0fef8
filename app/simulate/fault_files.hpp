#pragma once

#include <string>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// The faults of a file, or of an entry of the fault library by its name ("wheel-slip"). Throws InputError.
std::vector<Fault> faults_named(const std::string& file_or_name);

}  // namespace lodestar
