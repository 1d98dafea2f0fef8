#pragma once

#include <vector>

#include "app/simulate/simulated_drives.hpp"

namespace lodestar {

/// Prints a row for each run and the totals: worst errors, ratio of driving time to ideal time, NEES.
/// `cpu_s`: CPU time of all cores.
void print_run_table(const std::vector<RunSummary>& runs, double cpu_s);

}  // namespace lodestar
