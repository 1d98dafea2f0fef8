#include "app/console/run_facts.hpp"

#include <algorithm>

#include "app/common/rounding.hpp"
#include "app/common/wall_clock.hpp"
#include "app/recording/run_origin.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;
using namespace nlohmann::literals;

/// Only the judge of a simulated world knows of contacts.
bool is_simulated(const fs::path& folder) {
  return is_file(folder / "truth.tum") && fs::file_size(folder / "truth.tum") > 0;
}

void add_outcome(ordered_json& facts, const json& goals) {
  facts["goals"] = goals.size();
  facts["arrived"] =
      std::ranges::count_if(goals, [](const json& goal) { return goal.value("arrived", false); });
  const auto failed =
      std::ranges::find_if(goals, [](const json& goal) { return !goal.value("arrived", false); });
  if (failed == goals.end()) return;
  const auto why = failed->value("failure", "");
  facts["why"] = why.empty() ? "never started" : why;
}

}  // namespace

bool is_complete(const fs::path& folder) {
  return is_file(folder / "summary.json") && is_file(folder / "estimate.tum");
}

std::optional<RunOrigin> origin_if_any(const fs::path& folder) {
  try {
    return read_run_origin(folder);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

ordered_json summary_of_run(const fs::path& file) {
  ordered_json summary = ordered_json::parse(file_text(file, "a summary"), nullptr, false);
  if (!summary.is_object()) throw InputError(file, 0, "broken JSON", "a summary");
  return summary;
}

ordered_json facts_of_run(const fs::path& folder) {
  ordered_json facts{{"name", folder.filename().string()}};
  for (const char* key : {"started", "ended", "site", "goals", "arrived", "why", "contacts", "duration_s",
                          "driven_m", "worst_error_mm", "worst_3_sigma_mm"})
    facts[key] = nullptr;
  if (const std::optional<RunOrigin> origin = origin_if_any(folder)) {
    facts["started"] = origin->started;
    facts["site"] = origin->site;
  }
  const fs::path file = folder / "summary.json";
  if (!is_complete(folder)) return facts;
  const json summary = summary_of_run(file);
  facts["ended"] = utc_text(std::chrono::file_clock::to_sys(fs::last_write_time(file)));
  facts["site"] = summary.value("site", "");
  add_outcome(facts, summary.value("goals", json::array()));
  if (is_simulated(folder)) facts["contacts"] = summary.value("contacts", 0);
  facts["duration_s"] = summary.value("duration_s", summary.value("time_s", 0.0));
  facts["driven_m"] = summary.value("driven_m", 0.0);
  const auto in_mm = [&](const json::json_pointer& where, double factor) -> ordered_json {
    if (!summary.contains(where) || !summary[where].is_number()) return nullptr;
    return rounded(factor * summary[where].get<double>(), 10.0);
  };
  facts["worst_error_mm"] = in_mm("/estimate_position_error_m/max"_json_pointer, 1000.0);
  facts["worst_3_sigma_mm"] = in_mm("/largest_position_sigma_m"_json_pointer, 3000.0);
  return facts;
}

}  // namespace lodestar
