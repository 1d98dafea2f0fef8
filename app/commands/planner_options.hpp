#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/placement/uncertainty_constraint.hpp"
#include "planning/grid_planner.hpp"

// Planner options shared by several commands.
namespace lodestar {

/// The values of --planner.
std::vector<std::string> planner_names();

/// Adds --max-sigma, --drift, --keep-markers and --blind-way.
void add_uncertainty_constraint_options(CLI::App& command, UncertaintyConstraintOptions& constraint);

/// The same options as command-line arguments, each after a space; empty when none is set.
std::string words_of(const UncertaintyConstraintOptions& constraint);

/// Adds --time-limit, --iterations and --enough; the seed is the command's own.
void add_sampling_options(CLI::App& command, SamplingOptions& sampling);

}  // namespace lodestar
