#pragma once

#include "app/report/run_record.hpp"

namespace lodestar {

/// A line on standard output for each goal of a drive: when it was reached, and where there is a judge how
/// well; or why not.
void print_goals(const RunRecord& record);

}  // namespace lodestar
