#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/recording/run_origin.hpp"

namespace lodestar {

/// Has the run ended, with a report?
bool is_complete(const std::filesystem::path& folder);

/// A run's run.yaml; one that cannot be read hides nothing else of the run.
std::optional<RunOrigin> origin_if_any(const std::filesystem::path& folder);

/// A run's summary.json. Throws InputError for a file that is none.
nlohmann::ordered_json summary_of_run(const std::filesystem::path& file);

/// {"name", "started", "ended", "site", "goals", "arrived", "why", "contacts", "duration_s", "driven_m",
/// "worst_error_mm", "worst_3_sigma_mm"}: `started` and `ended` in UTC (null where nobody wrote it down),
/// `why` of the first goal that was not reached; the error is null on a real robot, which does not know it.
/// Of a run without a report all but name, `started` and `site` are null: it is under way, or its program
/// ended in the middle.
nlohmann::ordered_json facts_of_run(const std::filesystem::path& folder);

}  // namespace lodestar
