#pragma once

#include <cstdint>
#include <vector>

#include "app/bench/plan_queries.hpp"
#include "planning/grid_planner.hpp"

// One planner on random queries on one map: times, memory, and travel time compared with the best known.
namespace lodestar {

struct MapBenchOptions {
  int queries = 100;
  std::uint64_t seed = 1;
  double least_distance_m = 1.0;  ///< from start to goal
  GridPlannerOptions planner;
  /// Other planners, whose paths count among the best known.
  std::vector<GridPlannerOptions> references;
};

struct MapBenchAnswer {
  PlanQuery query;
  bool found = false;
  double microseconds = 0.0;
  double travel_time_s = 0.0;
  double best_s = 0.0;  ///< least travel time that any of the planners found
  std::size_t expanded = 0;
};

struct MapBenchResult {
  double prepare_us = 0.0;        ///< of the planner, for a new map
  double prepare_again_us = 0.0;  ///< after a local change: a box of half a metre was put into the map
  double peak_memory_mb = 0.0;    ///< of the process, before the references run
  std::vector<MapBenchAnswer> answers;
};

/// Start and goal are random clear points in the same connected region.
MapBenchResult bench_map(const OccupancyMap& map, const MapBenchOptions& options);

}  // namespace lodestar
