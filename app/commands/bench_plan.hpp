#pragma once

#include "app/commands/commands.hpp"

namespace lodestar {

/// The subcommand `lodestar bench plan`.
Command bench_plan_command(CLI::App& bench);

}  // namespace lodestar
