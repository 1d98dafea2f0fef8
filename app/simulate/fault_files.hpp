#pragma once

#include <string>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// The faults of a file, or of one of the library by its name ("wheel-slip"). Throws InputError.
std::vector<Fault> faults_named(const std::string& file_or_name);

}  // namespace lodestar
