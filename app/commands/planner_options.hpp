#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "planning/grid_planner.hpp"

// The options of planners that several commands share.
namespace lodestar {

/// What --planner may be.
std::vector<std::string> planner_names();

/// Adds --time-limit, --iterations and --enough; the seed is the command's own.
void add_sampling_options(CLI::App& command, SamplingOptions& sampling);

}  // namespace lodestar
