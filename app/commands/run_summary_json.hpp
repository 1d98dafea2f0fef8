#pragma once

#include <nlohmann/json.hpp>

#include "app/simulate/simulated_drives.hpp"

namespace lodestar {

/// A run in a line of `replay --json`.
nlohmann::ordered_json as_json(const RunSummary& run);

}  // namespace lodestar
