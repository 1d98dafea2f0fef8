#pragma once

#include <string>

#include "app/report/run_record.hpp"

namespace lodestar {

/// A self-contained page on a run: key figures, goals, the figure (`map_png`, its bytes), and plots over
/// time.
std::string report_html(const RunRecord& record, const std::string& map_png);

}  // namespace lodestar
