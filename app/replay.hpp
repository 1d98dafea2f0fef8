#pragma once

#include <functional>

#include "app/report/run_record.hpp"
#include "app/site.hpp"
#include "drivers/fault.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {

struct ReplayOptions {
  std::string camera;  ///< a profile of the site
  std::uint64_t seed = 1;
  std::vector<Goal> goals;
  PlannerKind planner = PlannerKind::fastest;
  std::vector<Fault> faults;
  bool realtime = false;  ///< no faster than the world's own time
  /// Called after each step of the navigator with the wall time that it took.
  std::function<void(std::chrono::nanoseconds)> on_step;
  std::function<void(double)> progress;  ///< called now and then with the share that is done, 0..1
};

/// Drives the simulated robot through the goals: the same navigator as on the real one, simulated drivers.
RunRecord replay(const Site& site, const ReplayOptions& options);

}  // namespace lodestar
