#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/navigation/navigation.hpp"
#include "app/site/route_graph.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Previews a drive: plans as the navigator would, without driving.
class PathPreview {
 public:
  /// Keeps out of what these places say.
  PathPreview(const Site& site, const Places& places);

  /// From a pose through all goals: {"points", "length_m", "time_s", "turns"}, or {"why", "goal", "nearest"}:
  /// the reason in words, the number (from 0) of the goal that cannot be reached, and the place nearest to it
  /// that can, if any.
  [[nodiscard]] nlohmann::ordered_json plan(const Pose2& start, const std::vector<Goal>& goals) const;
  /// The same along the edges of the places, "goal" being the last one where a line is not clear. Throws
  /// InputError where no edges lead to a goal.
  [[nodiscard]] nlohmann::ordered_json plan_over_edges(const Pose2& start,
                                                       const std::vector<Goal>& goals) const;

 private:
  RouteGraph routes_;
  NavigationOptions options_;
  MarginPlanner planner_;
};

}  // namespace lodestar
