#include "app/simulate/simulated_drives.hpp"

#include <algorithm>
#include <atomic>

#include "app/common/parallel.hpp"
#include "app/report/run_statistics.hpp"

namespace lodestar {

RunSummary summarize(const RunRecord& record) {
  RunSummary summary;
  summary.seed = record.seed;
  summary.goals = static_cast<int>(record.goals.size());
  for (std::size_t i = 0; i < record.goals.size(); ++i) {
    const GoalRecord& goal = record.goals[i];
    summary.arrivals += goal.arrived ? 1 : 0;
    if (goal.arrived) {
      summary.travel_s += seconds(goal.travel_time);
      summary.ideal_s += goal.ideal_s;
    }
    if (const std::optional<ArrivalScore> score = record.score_of(i)) {
      summary.worst_position_m = std::max(summary.worst_position_m, std::optional(score->position_error_m));
      summary.worst_heading_rad = std::max(summary.worst_heading_rad, score->heading_error_rad);
    }
    if (summary.failure.empty()) summary.failure = goal.failure;
  }
  summary.path_p95_m = percentile(record.path_distances_m, 0.95).value_or(0.0);
  summary.contacts = record.contacts;
  summary.drive_s = record.truth.empty() ? 0.0 : seconds(record.truth.back().stamp);
  summary.nees_samples = nees_samples(record);
  summary.nees = mean_nees(estimate_errors(record)).value_or(0.0);
  summary.wall_s = record.wall_time_s;
  return summary;
}

std::vector<RunSummary> simulate_drives(const Site& site, const SimulatedDriveOptions& options, int runs,
                                        const std::function<void(int)>& done) {
  std::vector<std::optional<RunSummary>> summaries(static_cast<std::size_t>(runs));
  const auto is_over = [&] { return options.goes_on && !options.goes_on(); };
  std::atomic<int> finished = 0;
  in_parallel(runs, [&](int i) {
    if (is_over()) return;
    SimulatedDriveOptions run = options;
    run.seed = options.seed + static_cast<std::uint64_t>(i);
    run.progress = nullptr;
    const RunRecord record = simulate_drive(site, run);
    if (is_over()) return;  // perhaps in the middle of this one
    RunSummary summary = summarize(record);
    if (options.has_people_or_things()) summary.people = record.contact_score;
    summaries[static_cast<std::size_t>(i)] = std::move(summary);
    done(++finished);
  });
  std::vector<RunSummary> whole;
  for (std::optional<RunSummary>& summary : summaries)
    if (summary) whole.push_back(std::move(*summary));
  return whole;
}

}  // namespace lodestar
