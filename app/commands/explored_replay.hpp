#pragma once

#include <filesystem>

#include "app/common/command.hpp"
#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

/// `replay --survey --explore`: the simulated robot knows none of the markers, surveys them by driving, and
/// leaves its log in this folder. The same seed gives the same bytes.
ExitCode replay_exploring(const Site& site, SimulatedDriveOptions options,
                          const std::filesystem::path& folder);

}  // namespace lodestar
