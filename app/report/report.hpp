#pragma once

#include <string>

#include "app/report/run_record.hpp"

namespace lodestar {

/// One page that tells the run: facts, goals, the figure (`map_png`, its bytes), and plots over time.
/// Self-contained.
std::string report_html(const RunRecord& record, const std::string& map_png);

}  // namespace lodestar
