#pragma once

#include <vector>

#include "app/common/command.hpp"

// The commands that host parts of the simulated world for other programs. They may hear its judge.
namespace lodestar {

/// `base`: the simulated base on a CAN interface.
std::vector<Command> base_commands(CLI::App& lodestar);

}  // namespace lodestar
