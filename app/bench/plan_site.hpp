#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/site/site.hpp"
#include "planning/grid_planner.hpp"

// All planners on the same random queries on a site's map, with its robot.
namespace lodestar {

struct SiteBenchOptions {
  int queries = 100;
  std::uint64_t seed = 1;
  double least_distance_m = 1.0;   ///< from start to goal
  SamplingOptions sampling;        ///< of the planners of OMPL
  std::vector<PlannerKind> kinds;  ///< in the order of the table
};

/// Medians over the queries. Ratios are to the best path that any planner found for that query.
struct PlannerResult {
  PlannerKind kind = PlannerKind::astar;
  int found = 0;
  double microseconds = 0.0;
  double length_ratio = 0.0;
  double worst_length_ratio = 0.0;
  double travel_time_ratio = 0.0;
  double mean_turns = 0.0;
};

struct SiteBenchResult {
  int queries = 0;
  double grid_microseconds = 0.0;  ///< of the 8-connected search alone, between the same cells
  std::vector<PlannerResult> planners;
};

/// Start and goal are random clear points in the same connected region. All planners run on each query in
/// turn.
SiteBenchResult bench_site(const Site& site, const SiteBenchOptions& options);

}  // namespace lodestar
