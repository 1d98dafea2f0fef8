#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "app/report/nees.hpp"
#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

/// One run's row in the table of many.
struct RunSummary {
  std::uint64_t seed = 0;
  int goals = 0;
  int arrivals = 0;
  std::optional<double> worst_position_m;   ///< largest true distance from a goal on arrival, if at any
  std::optional<double> worst_heading_rad;  ///< largest true heading error on arrival, where one was wanted
  double path_p95_m = 0.0;  ///< 95th percentile of the true track's distance from the planned curve
  int contacts = 0;
  std::optional<ContactScore> people;  ///< where people walk about
  double drive_s = 0.0;                ///< simulated
  double travel_s = 0.0;  ///< of that, from path planned to arrival reported, summed over goals reached
  double ideal_s = 0.0;   ///< ideal travel time of their paths
  std::vector<NeesSample> nees_samples;
  double nees = 0.0;  ///< mean normalized estimation error squared: 3 for a consistent filter
  double wall_s = 0.0;
  std::string failure;  ///< the first, in words
};

RunSummary summarize(const RunRecord& record);

/// Runs with the seeds options.seed, options.seed + 1, ... on all cores; results in the order of the seeds.
/// `done` is called after each, from any thread, with the number of finished runs. Once options.goes_on says
/// no, the drives at hand are dropped and no more begin: the result has those that were finished.
std::vector<RunSummary> simulate_drives(const Site& site, const SimulatedDriveOptions& options, int runs,
                                        const std::function<void(int)>& done);

}  // namespace lodestar
