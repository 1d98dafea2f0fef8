#pragma once

#include <string>

#include "app/bench/plan_map.hpp"

namespace lodestar {

struct BenchPlanMapArguments {
  std::string map;        ///< a map_server YAML file
  std::string generated;  ///< or the name of a generated map
  MapBenchOptions bench;
  bool json = false;
  double beside_s = 0.0;  ///< above 0: measure the control period beside the planner instead, for so long
};

/// `lodestar bench plan --map F.yaml` and `--generated NAME`: prints the times and travel times of the
/// default planner, or the control loop's period beside it.
void bench_on_map(BenchPlanMapArguments arguments);

}  // namespace lodestar
