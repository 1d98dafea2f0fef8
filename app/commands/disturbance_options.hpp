#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "app/simulate/disturbances.hpp"

// Disturbances of a simulated drive as options.
namespace lodestar {

struct DisturbanceArguments {
  Disturbances values;  ///< but for those below
  std::string hung;     ///< a file
  double misturned_deg = 0.0;
  double tilted_deg = 0.0;
};

/// Adds --lose-frames, --unequal-wheels, --remove-markers, --plain-ceiling, --hang, --misplace-markers,
/// --misturn-markers, --tilt-markers and --print-scale.
void add_disturbance_options(CLI::App& command, DisturbanceArguments& arguments);

/// Throws InputError for a file of markers that cannot be read.
Disturbances disturbances_of(const DisturbanceArguments& arguments);

/// The same options as command-line arguments, each after a space; empty when none is set.
std::string words_of(const DisturbanceArguments& arguments);

}  // namespace lodestar
