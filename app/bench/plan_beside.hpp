#pragma once

#include <vector>

#include "app/bench/plan_queries.hpp"
#include "maps/stamp.hpp"
#include "planning/grid_planner.hpp"

// The control loop's period while a planner beside it works all the time.
namespace lodestar {

struct PlanBesideResult {
  std::vector<double> period_ms;  ///< from one step to the next; 20 ms are wanted
  int plans = 0;
  int new_maps = 0;
};

/// A loop of 20 ms that asks for the next plan as soon as the last one has arrived, and sets a new map every
/// second. Each step looks along the clearance ahead, as the navigator does.
PlanBesideResult bench_plan_beside(const OccupancyMap& map, const GridPlannerOptions& planner,
                                   const std::vector<PlanQuery>& queries, Duration duration);

}  // namespace lodestar
