#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "app/report/nees.hpp"
#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

/// What a table of many runs keeps of one.
struct RunSummary {
  std::uint64_t seed = 0;
  int goals = 0;
  int arrivals = 0;
  double worst_position_m = 0.0;   ///< largest true distance from a goal on arrival
  double worst_heading_rad = 0.0;  ///< largest true heading error on arrival
  double path_p95_m = 0.0;         ///< 95th percentile of the true track's distance from the planned curve
  int contacts = 0;
  double drive_s = 0.0;   ///< simulated
  double travel_s = 0.0;  ///< of that, from each path planned to the arrival claimed, of all goals reached
  double ideal_s = 0.0;   ///< that their paths take at best
  std::vector<NeesSample> nees_samples;
  double nees = 0.0;  ///< mean normalized estimation error squared: 3 for an honest filter
  double wall_s = 0.0;
  std::string failure;  ///< the first, in words
};

RunSummary summarize(const RunRecord& record);

/// Runs with the seeds options.seed, options.seed + 1, ... on all cores; results in the order of the seeds.
/// `done` is called after each, from any thread, with the number of finished runs.
std::vector<RunSummary> simulate_drives(const Site& site, const SimulatedDriveOptions& options, int runs,
                                        const std::function<void(int)>& done);

}  // namespace lodestar
