#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "planning/sampling_search.hpp"

namespace lodestar {

/// By which method a path is found; docs/planning.md says which one when.
enum class PlannerKind {
  astar,     ///< the shortest (or, with clearance, cheapest) 8-connected path, then shortened to few straight
             ///< legs
  anyangle,  ///< the shortest path of straight legs
  fastest,   ///< the path on which a robot that turns on the spot and drives straight arrives first
  rrtstar,   ///< and all below: sampling planners of OMPL, their path shortened as that of astar
  informedrrtstar,
  bitstar,
  abitstar,
  prmstar
};

/// The name on the command line and back; nothing for a name that is none.
std::string_view to_string(PlannerKind kind);
std::optional<PlannerKind> planner_kind(std::string_view name);
std::vector<PlannerKind> all_planner_kinds();

/// Which of OMPL's planners that is; nothing for our own.
std::optional<SamplingMethod> sampling_method(PlannerKind kind);

}  // namespace lodestar
