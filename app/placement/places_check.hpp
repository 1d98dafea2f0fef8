#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"

namespace lodestar {

enum class PlacesIssueKind {
  in_obstacle,  ///< or beside the map
  in_keep_out,
  unreachable,  ///< from the other places
  blocked_edge,
  unreachable_by_edges,  ///< from the first place on an edge
  lonely_node,           ///< no edge leads there
  zone_off_map,
  blind_mission,  ///< no marker is sure to be seen for more than a metre of it
  blind_edge
};

/// The name in reports: `in-keep-out`.
std::string_view to_string(PlacesIssueKind kind);

/// An error or a warning about the places of a site.
struct PlacesIssue {
  PlacesIssueKind kind = PlacesIssueKind::in_obstacle;
  bool error = true;
  std::string words;
  std::vector<Vec2> positions_m;  ///< on the map, for a view to go there
};

/// {"kind", "severity", "words", "positions_m"}.
nlohmann::ordered_json issue_json(const PlacesIssue& issue);

/// What the site's robot cannot do: stand at a place, at the start or at a goal; drive from one to another
/// (those are named that are not in the largest group of places that reach each other); drive straight along
/// an edge. Warnings: nodes without an edge, zones that do not touch the map, stretches of missions and edges
/// without a marker in view. Errors come first. `floor`: covered_floor() of the site, where it is there
/// already.
std::vector<PlacesIssue> check_places(const Site& site, const CoveredFloor* floor = nullptr);

}  // namespace lodestar
