#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/placement/pose_keeping.hpp"
#include "planning/grid_planner.hpp"

// The options of planners that several commands share.
namespace lodestar {

/// What --planner may be.
std::vector<std::string> planner_names();

/// Adds --max-sigma, --drift, --keep-markers and --blind-way.
void add_pose_keeping_options(CLI::App& command, PoseKeepingOptions& keeping);

/// The same options as words of a command line, each after a space; empty when none is wanted.
std::string words_of(const PoseKeepingOptions& keeping);

/// Adds --time-limit, --iterations and --enough; the seed is the command's own.
void add_sampling_options(CLI::App& command, SamplingOptions& sampling);

}  // namespace lodestar
