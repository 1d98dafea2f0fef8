#pragma once

#include <vector>

#include "app/common/command.hpp"

// Commands that host parts of the simulated world for other programs. They may use its ground truth.
namespace lodestar {

/// `base`: the simulated base on a CAN interface.
std::vector<Command> base_commands(CLI::App& lodestar);

/// `scanner`: a simulated laser scanner at a serial line or on the network.
std::vector<Command> scanner_commands(CLI::App& lodestar);

}  // namespace lodestar
