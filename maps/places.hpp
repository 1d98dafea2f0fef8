#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "maps/convex_pieces.hpp"
#include "maps/geometry.hpp"

// What people name on a map: where to go, which ways lead there, and where not to go or not so fast. All
// coordinates are of the map frame. docs/places.md has the file.
namespace lodestar {

/// A station to drive to.
struct Place {
  std::string name;
  Vec2 position_m = Vec2::Zero();
  std::optional<double> yaw_rad;  ///< the final heading; nothing: any
};

/// A point of the route graph where nobody stops.
struct RouteNode {
  std::string name;
  Vec2 position_m = Vec2::Zero();
};

/// A straight way between two points of the route graph, which may be places or nodes.
struct RouteEdge {
  std::string from;
  std::string to;
  bool one_way = false;           ///< only from `from` to `to`
  std::optional<double> max_mps;  ///< nothing: the robot's own limit
};

/// No part of the robot may be here.
struct KeepOut {
  std::string name;   ///< may be empty
  Polygon corners_m;  ///< of either sense of rotation
};

/// While any part of the robot is here, it drives no faster than this.
struct SpeedZone {
  std::string name;   ///< may be empty
  Polygon corners_m;  ///< of either sense of rotation
  double max_mps = 0.0;
};

/// A place that a mission drives to, and what is done there before it drives on.
struct MissionStop {
  std::string place;
  double wait_s = 0.0;  ///< at rest
  std::string action;   ///< a type among the `actions` of site.yaml; empty: none

  friend bool operator==(const MissionStop&, const MissionStop&) = default;
};

/// Stops in driving order, all of them `repeat` times.
struct NamedMission {
  static constexpr int most_goals = 500;  ///< stops times repeat: an operator's console shows them all

  std::string name;
  std::vector<MissionStop> stops;
  int repeat = 1;
};

/// places.yaml of a site folder. Names are unique among places and nodes together, among the missions, and
/// among the zones of a kind that have one.
struct Places {
  std::vector<Place> places;
  std::vector<RouteNode> nodes;
  std::vector<RouteEdge> edges;
  std::vector<KeepOut> keep_out;
  std::vector<SpeedZone> speed_zones;
  std::vector<NamedMission> missions;

  /// Null for an unknown name.
  [[nodiscard]] const Place* find(const std::string& name) const;

  /// Of a place or a node; nothing for an unknown name.
  [[nodiscard]] std::optional<Vec2> position_m(const std::string& name) const;
};

/// In a site folder: the file, and the one that the console kept before.
inline constexpr const char* places_file_name = "places.yaml";
inline constexpr const char* older_places_file_name = "routes.yaml";

/// Strict: throws InputError with file and line, also for a name twice, an edge to or a mission over
/// something that nobody defined, and a polygon with less than three corners or one that crosses itself.
/// JSON of the same shape is read as well. `file` is used in error messages only.
Places parse_places(const std::string& text, const std::filesystem::path& file);

/// The same for the older `lodestar-routes`: places and `routes` over them, which became the missions.
Places parse_routes(const std::string& text, const std::filesystem::path& file);

/// Of a site folder: its places.yaml; where there is only an older routes.yaml, what that has; without
/// either none.
Places load_places(const std::filesystem::path& folder);

/// The content of places.yaml: one item per line, in the order given; numbers to a nanometre.
std::string places_text(const Places& places);

/// Writes places.yaml of a site folder in one step. An older routes.yaml is kept as routes.yaml.old: what it
/// has was loaded with the places.
void save_places(const Places& places, const std::filesystem::path& folder);

}  // namespace lodestar
