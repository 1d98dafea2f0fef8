#include "app/placement/registry_check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

#include "maps/marker.hpp"
#include "maps/marker_code.hpp"

namespace lodestar {
namespace {

/// Of the printed square: to the outer edge of the outermost dots.
constexpr double half_side_m = 0.5 * (marker_grid_size - 1) * marker_pitch_m + marker_dot_radius_m;

/// The marker's square on the ceiling, its frame at the centre.
Pose2 center_of(const MarkerRegistry& registry, const RegisteredMarker& marker) {
  return {center_in_map(registry, marker).head<2>(), flattened(map_from_marker(registry, marker)).yaw_rad};
}

/// One issue per ID, however often it is repeated.
void find_repeated_ids(const MarkerRegistry& registry, std::vector<RegistryIssue>& issues) {
  std::map<int, int> times;
  for (const RegisteredMarker& marker : registry.markers) {
    if (++times[marker.id] != 2) continue;
    issues.push_back({IssueKind::repeated_id,
                      true,
                      {marker.id},
                      marker.line,
                      fmt::format("marker {} stands twice; each ID may stand once", marker.id),
                      {}});
  }
}

std::array<Vec2, 4> corners_of(const Pose2& square) {
  return {square * Vec2(-half_side_m, -half_side_m), square * Vec2(half_side_m, -half_side_m),
          square * Vec2(half_side_m, half_side_m), square * Vec2(-half_side_m, half_side_m)};
}

/// Is there a gap between the squares along one of the axes of `a`? (separating axis theorem)
bool parted_by_axes_of(const Pose2& a, const Pose2& b) {
  const Pose2 a_from_map = inverse(a);
  Vec2 low = Vec2::Constant(1e300);
  Vec2 high = -low;
  for (const Vec2& corner : corners_of(b)) {
    const Vec2 in_a = a_from_map * corner;
    low = low.cwiseMin(in_a);
    high = high.cwiseMax(in_a);
  }
  return (low.array() >= half_side_m).any() || (high.array() <= -half_side_m).any();
}

double apart_m(const RegisteredMarker& a, const RegisteredMarker& b) {
  return (a.position_m - b.position_m).norm();
}

void note(DistanceReport& report, int distance, const RegisteredMarker& a, const RegisteredMarker& b) {
  if (report.closest_pairs.empty() || distance < report.smallest) {
    report.smallest = distance;
    report.closest_pairs.clear();
  }
  if (distance == report.smallest) report.closest_pairs.push_back({a.id, b.id, apart_m(a, b)});
}

void find_overlaps(const MarkerRegistry& registry, std::vector<RegistryIssue>& issues) {
  std::vector<Pose2> squares;
  for (const RegisteredMarker& marker : registry.markers) squares.push_back(center_of(registry, marker));
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    for (std::size_t j = i + 1; j < registry.markers.size(); ++j) {
      const RegisteredMarker& a = registry.markers[i];
      const RegisteredMarker& b = registry.markers[j];
      const Pose2& square_a = squares[i];
      const Pose2& square_b = squares[j];
      if ((square_a.position_m - square_b.position_m).cwiseAbs().maxCoeff() > 4.0 * half_side_m) continue;
      if (parted_by_axes_of(square_a, square_b) || parted_by_axes_of(square_b, square_a)) continue;
      issues.push_back({IssueKind::overlapping,
                        true,
                        {a.id, b.id},
                        a.line,
                        fmt::format("markers {} and {} overlap", a.id, b.id),
                        {}});
    }
  }
}

void find_outsiders(const MarkerRegistry& registry, const OccupancyMap& map,
                    std::vector<RegistryIssue>& issues) {
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec2 center = center_of(registry, marker).position_m;
    if (map.contains(map.cell_at(center))) continue;
    issues.push_back(
        {IssueKind::outside_map,
         true,
         {marker.id},
         marker.line,
         fmt::format("marker {} at {:.2f}, {:.2f} m lies outside the map", marker.id, center.x(), center.y()),
         {}});
  }
}

void find_similar_ids(const MarkerRegistry& registry, std::vector<RegistryIssue>& issues) {
  const std::vector<RegisteredMarker>& markers = registry.markers;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t j = i + 1; j < markers.size(); ++j) {
      const RegisteredMarker& a = markers[i];
      const RegisteredMarker& b = markers[j];
      if (a.id == b.id) continue;  // reported as a repeated ID
      if (id_distance(a.id, b.id) == 1) {
        issues.push_back(
            {IssueKind::similar_ids,
             false,
             {a.id, b.id},
             a.line,
             fmt::format("markers {} and {}, {:.2f} m apart, differ in one dot: when it is lost, or "
                         "a glint stands there, the one is read as the other",
                         a.id, b.id, apart_m(a, b)),
             {}});
      }
      if (is_turned(a.id, b.id)) {
        issues.push_back({IssueKind::mirror_images,
                          false,
                          {a.id, b.id},
                          a.line,
                          fmt::format("markers {} and {}, {:.2f} m apart, are each other's mirror image",
                                      a.id, b.id, apart_m(a, b)),
                          {}});
      }
    }
  }
}

/// Adds the positions of the markers that each issue names.
void find_places(const MarkerRegistry& registry, std::vector<RegistryIssue>& issues) {
  std::multimap<int, Vec2> places;
  for (const RegisteredMarker& marker : registry.markers)
    places.emplace(marker.id, map_from_marker(registry, marker).translation().head<2>());
  for (RegistryIssue& issue : issues) {
    for (const int id : issue.ids) {
      const auto [first, last] = places.equal_range(id);
      for (auto place = first; place != last; ++place) issue.places_m.push_back(place->second);
    }
  }
}

}  // namespace

std::string_view to_string(IssueKind kind) {
  switch (kind) {
    case IssueKind::repeated_id:
      return "repeated-id";
    case IssueKind::overlapping:
      return "overlapping";
    case IssueKind::outside_map:
      return "outside-map";
    case IssueKind::similar_ids:
      return "similar-ids";
    case IssueKind::mirror_images:
      return "mirror-images";
    case IssueKind::implausible_height:
      return "implausible-height";
    case IssueKind::inside_structure:
      return "inside-structure";
    case IssueKind::blind_route:
      return "blind-route";
    case IssueKind::gap:
      return "gap";
  }
  return "";
}

std::optional<IssueKind> issue_kind_named(std::string_view name) {
  for (int kind = 0; kind <= static_cast<int>(IssueKind::gap); ++kind)
    if (to_string(static_cast<IssueKind>(kind)) == name) return static_cast<IssueKind>(kind);
  return std::nullopt;
}

nlohmann::ordered_json issue_json(const RegistryIssue& issue) {
  nlohmann::ordered_json json{
      {"kind", to_string(issue.kind)}, {"severity", issue.error ? "error" : "warning"}, {"ids", issue.ids}};
  if (issue.line > 0) json["line"] = issue.line;
  json["words"] = issue.words;
  json["places_m"] = nlohmann::ordered_json::array();
  for (const Vec2& place : issue.places_m) json["places_m"].push_back({place.x(), place.y()});
  return json;
}

Vec3 center_in_map(const MarkerRegistry& registry, const RegisteredMarker& marker) {
  constexpr double to_middle_m = 0.5 * (marker_grid_size - 1) * marker_pitch_m;
  return map_from_marker(registry, marker) * Vec3(to_middle_m, to_middle_m, 0.0);
}

DistanceReport upright_distances(const MarkerRegistry& registry) {
  DistanceReport report;
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    for (std::size_t j = i + 1; j < registry.markers.size(); ++j) {
      const RegisteredMarker& a = registry.markers[i];
      const RegisteredMarker& b = registry.markers[j];
      note(report, id_distance(a.id, b.id), a, b);
    }
  }
  return report;
}

DistanceReport turned_distances(const MarkerRegistry& registry) {
  DistanceReport report;
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    for (std::size_t j = i; j < registry.markers.size(); ++j) {
      const RegisteredMarker& a = registry.markers[i];
      const RegisteredMarker& b = registry.markers[j];
      note(report, turned_distance(a.id, b.id), a, b);
    }
  }
  return report;
}

std::vector<RegistryIssue> check_registry(const MarkerRegistry& registry,
                                          const std::optional<OccupancyMap>& map) {
  std::vector<RegistryIssue> issues;
  find_repeated_ids(registry, issues);
  find_overlaps(registry, issues);
  if (map) find_outsiders(registry, *map, issues);
  find_similar_ids(registry, issues);
  find_places(registry, issues);
  return issues;
}

}  // namespace lodestar
