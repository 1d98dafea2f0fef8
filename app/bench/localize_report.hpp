#pragma once

#include <nlohmann/json.hpp>

#include "app/bench/localize_run.hpp"

namespace lodestar {

/// All figures, with units in the keys.
nlohmann::ordered_json bench_localize_json(const BenchLocalizeResult& result);

/// Tables for a terminal.
std::string bench_localize_text(const BenchLocalizeResult& result);

/// One self-contained page: the tables, and charts for each sweep.
std::string bench_localize_html(const BenchLocalizeResult& result);

}  // namespace lodestar
