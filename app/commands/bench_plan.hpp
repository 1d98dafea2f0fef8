#pragma once

#include "app/commands/commands.hpp"

namespace lodestar {

/// `lodestar bench plan`, a word under `bench`.
Command bench_plan_command(CLI::App& bench);

}  // namespace lodestar
