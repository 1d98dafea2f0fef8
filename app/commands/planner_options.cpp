#include "app/commands/planner_options.hpp"

#include <fmt/format.h>

namespace lodestar {

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const PlannerKind kind : all_planner_kinds()) names.emplace_back(to_string(kind));
  return names;
}

void add_uncertainty_constraint_options(CLI::App& command, UncertaintyConstraintOptions& constraint) {
  CLI::Option* sigma = command.add_option(
      "--max-sigma", constraint.max_sigma_m,
      "Only paths on which the predicted standard deviation of the position stays below this, in metres");
  sigma->check(CLI::Range(1e-4, 10.0));
  command
      .add_option("--drift", constraint.drift_m_per_m,
                  "With --max-sigma: its growth between fixes, metres per metre")
      ->check(CLI::Range(0.0, 1.0))
      ->needs(sigma)
      ->capture_default_str();
  CLI::Option* markers = command.add_option(
      "--keep-markers", constraint.markers_in_view,
      "Instead: only paths on which at least this many markers are in view, at every heading");
  markers->check(CLI::Range(1, 100))->excludes(sigma);
  command
      .add_option("--blind-way", constraint.blind_way_m,
                  "With --keep-markers: except for stretches up to this length, in metres")
      ->check(CLI::Range(0.0, 1000.0))
      ->needs(markers)
      ->capture_default_str();
}

std::string words_of(const UncertaintyConstraintOptions& constraint) {
  if (constraint.max_sigma_m)
    return fmt::format(" --max-sigma {} --drift {}", *constraint.max_sigma_m, constraint.drift_m_per_m);
  if (constraint.markers_in_view)
    return fmt::format(" --keep-markers {} --blind-way {}", *constraint.markers_in_view,
                       constraint.blind_way_m);
  return "";
}

void add_sampling_options(CLI::App& command, SamplingOptions& sampling) {
  command
      .add_option("--time-limit", sampling.time_limit_s,
                  "Time limit of sampling planners, in seconds; a plan that it cut off is not reproducible")
      ->check(CLI::Range(1e-3, 3600.0))
      ->capture_default_str();
  command.add_option("--iterations", sampling.max_iterations, "Iterations of sampling planners; 0: no limit")
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  command
      .add_option("--enough", sampling.enough_length_m,
                  "Sampling planners stop at a path no longer than this, in metres")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
}

}  // namespace lodestar
