#include "app/commands/planner_options.hpp"

namespace lodestar {

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const PlannerKind kind : all_planner_kinds()) names.emplace_back(to_string(kind));
  return names;
}

void add_sampling_options(CLI::App& command, SamplingOptions& sampling) {
  command
      .add_option("--time-limit", sampling.time_limit_s,
                  "Of sampling planners, in seconds; what it ends cannot be repeated to the byte")
      ->check(CLI::Range(1e-3, 3600.0))
      ->capture_default_str();
  command.add_option("--iterations", sampling.max_iterations, "Of sampling planners; 0 for no limit")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  command
      .add_option("--enough", sampling.enough_length_m,
                  "Sampling planners take a path no longer than this at once, in metres")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
}

}  // namespace lodestar
