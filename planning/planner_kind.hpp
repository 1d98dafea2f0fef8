#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "planning/sampling_search.hpp"

namespace lodestar {

/// Planning method; docs/planning.md says when to use which.
enum class PlannerKind {
  astar,     ///< the shortest (or, with clearance, cheapest) 8-connected path, then shortened to few straight
             ///< legs
  anyangle,  ///< the shortest path of straight legs
  fastest,   ///< the path on which a robot that turns on the spot and drives straight arrives first
  rrtstar,   ///< this and all below: sampling planners of OMPL, their path shortened as that of astar
  informedrrtstar,
  bitstar,
  abitstar,
  prmstar
};

/// The name on the command line, and back; nothing for an unknown name.
std::string_view to_string(PlannerKind kind);
std::optional<PlannerKind> planner_kind(std::string_view name);
std::vector<PlannerKind> all_planner_kinds();

/// The OMPL planner of a kind; nothing for our own planners.
std::optional<SamplingMethod> sampling_method(PlannerKind kind);

}  // namespace lodestar
