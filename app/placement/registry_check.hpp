#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/marker_registry.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

enum class IssueKind {
  repeated_id,
  overlapping,
  outside_map,
  similar_ids,
  mirror_images,
  implausible_height,  ///< this one and the next: see app/placement/plausibility.hpp
  inside_structure,
  blind_route,  ///< this one and the next: see app/placement/coverage.hpp
  gap
};

/// The name in reports: `outside-map`.
std::string_view to_string(IssueKind kind);
std::optional<IssueKind> issue_kind_named(std::string_view name);

/// An error or a warning about a registry.
struct RegistryIssue {
  IssueKind kind = IssueKind::overlapping;
  bool error = false;
  std::vector<int> ids;
  int line = 0;  ///< of the first marker concerned; 0 when none is
  std::string words;
  std::vector<Vec2> places_m;  ///< on the map, for a view to go there
};

/// {"kind", "severity", "ids", "line" where there is one, "words", "places_m"}, as in all reports.
nlohmann::ordered_json issue_json(const RegistryIssue& issue);

/// The centre of a marker's square, in the map.
Vec3 center_in_map(const MarkerRegistry& registry, const RegisteredMarker& marker);

/// Two markers; `first` equals `second` where a marker is compared with its own rotations.
struct MarkerPair {
  int first = 0;
  int second = 0;
  double apart_m = 0.0;  ///< on the ceiling, from O to O
  friend bool operator==(const MarkerPair&, const MarkerPair&) = default;
};

/// Hamming distances between the IDs of a registry: the number of cells (dots missed or glints added) that
/// must be misread to take one for another.
struct DistanceReport {
  int smallest = 0;  ///< 0 when nothing was compared
  std::vector<MarkerPair> closest_pairs;
};

/// Read upright: the IDs' Hamming distance. Needs two markers.
DistanceReport upright_distances(const MarkerRegistry& registry);

/// One of them rotated by quarter turns or mirrored; each marker is also compared with itself.
DistanceReport turned_distances(const MarkerRegistry& registry);

/// Duplicate IDs, markers whose printed squares overlap, markers outside the map (where one is given), IDs
/// one dot apart, markers that are each other's mirror image.
std::vector<RegistryIssue> check_registry(const MarkerRegistry& registry,
                                          const std::optional<OccupancyMap>& map);

}  // namespace lodestar
