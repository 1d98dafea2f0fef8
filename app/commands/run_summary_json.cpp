#include "app/commands/run_summary_json.hpp"

namespace lodestar {

nlohmann::ordered_json as_json(const RunSummary& run) {
  const auto optional = [](const std::optional<double>& value, double scale) {
    return value ? nlohmann::ordered_json(scale * *value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{{"seed", run.seed},
                              {"goals", run.goals},
                              {"arrivals", run.arrivals},
                              {"worst_position_m", optional(run.worst_position_m, 1.0)},
                              {"worst_heading_deg", optional(run.worst_heading_rad, degrees(1.0))},
                              {"path_p95_m", run.path_p95_m},
                              {"contacts", run.contacts},
                              {"drive_s", run.drive_s},
                              {"travel_s", run.travel_s},
                              {"ideal_s", run.ideal_s},
                              {"nees", run.nees},
                              {"failure", run.failure}};
  if (run.people) {
    json["contacts_moving"] = run.people->moving;
    json["contacts_excused"] = run.people->excused;
    json["contacts_at_rest"] = run.people->at_rest;
  }
  return json;
}

}  // namespace lodestar
