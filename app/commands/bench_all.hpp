#pragma once

#include "app/common/command.hpp"

namespace lodestar {

Command bench_all_command(CLI::App& bench);

}  // namespace lodestar
