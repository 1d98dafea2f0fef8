#pragma once

#include <vector>

#include "app/simulate/simulated_drives.hpp"

namespace lodestar {

/// Prints a row for each run, and what all of them come to: the worst errors, the time over the ideal, the
/// NEES. `cpu_s`: time of all cores that they took.
void print_run_table(const std::vector<RunSummary>& runs, double cpu_s);

}  // namespace lodestar
