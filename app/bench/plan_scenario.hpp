#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "maps/movingai_file.hpp"

// The queries of a MovingAI scenario, answered by the 8-connected search and checked against the file.
namespace lodestar {

struct ScenarioOptions {
  int repeats = 5;  ///< passes over all queries; the median time of each query is reported
};

struct ScenarioAnswer {
  MovingAiQuery query;
  std::optional<double> found;  ///< length in cells, from exact step counts; nothing without a path
  double microseconds = 0.0;
  double jps_plus_microseconds = 0.0;  ///< of JPS+ as published, from the same tables, timed as ours
  double astar_microseconds = 0.0;     ///< of a plain A* with a binary heap for the same query, once
  std::size_t expanded = 0;

  /// Length equal to the file's, to 1e-3 cells or to the file's rounding.
  [[nodiscard]] bool optimal() const;
};

std::vector<ScenarioAnswer> answer_scenario(const OccupancyMap& map,
                                            const std::vector<MovingAiQuery>& queries,
                                            const ScenarioOptions& options);

}  // namespace lodestar
