#pragma once

#include <optional>
#include <string>
#include <vector>

#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

enum class IssueKind { overlapping, outside_map, similar_ids };

/// Something wrong (error) or doubtful with a registry.
struct RegistryIssue {
  IssueKind kind = IssueKind::overlapping;
  bool error = false;
  std::vector<int> ids;
  int line = 0;  ///< of the first marker concerned
  std::string words;
};

/// How far apart the IDs of a registry are: the number of dots that must be misread to take one for another.
struct HammingReport {
  int smallest = 0;  ///< 0 when there are fewer than two markers
  std::vector<std::pair<int, int>> closest_pairs;
};

HammingReport hamming_report(const MarkerRegistry& registry);

/// Markers whose printed squares overlap, markers outside the map (where one is given), IDs one dot apart.
std::vector<RegistryIssue> check_registry(const MarkerRegistry& registry,
                                          const std::optional<OccupancyMap>& map);

}  // namespace lodestar
