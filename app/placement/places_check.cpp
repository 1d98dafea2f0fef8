#include "app/placement/places_check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/navigation/navigation_setup.hpp"
#include "app/placement/site_floor.hpp"
#include "app/site/route_graph.hpp"
#include "planning/collision_checker.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

/// Where the robot is to stand.
struct Station {
  std::string name;
  Vec2 position_m;
  std::optional<double> yaw_rad;
};

std::vector<Station> stations_of(const Site& site) {
  std::vector<Station> stations{{"the start", site.start.position_m, site.start.yaw_rad}};
  for (std::size_t i = 0; i < site.goals.size(); ++i)
    stations.push_back(
        {fmt::format("goal {} of site.yaml", i + 1), site.goals[i].position_m, site.goals[i].heading_rad});
  for (const Place& place : site.places.places)
    stations.push_back({"'" + place.name + "'", place.position_m, place.yaw_rad});
  if (const std::optional<ChargingSettings> charging = charging_at(site.charging, site.places)) {
    const Pose2 before = approach_pose(*charging);
    stations.push_back({"the pose in front of '" + charging->place + "'", before.position_m, before.yaw_rad});
  }
  return stations;
}

/// Whether the robot can stand somewhere: its disc; its footprint where the heading is known, else the disc
/// that is in every heading.
class Standing {
 public:
  Standing(const OccupancyMap& map, const Robot& robot)
      : footprint_(robot.footprint),
        checker_(map, robot.footprint ? robot.footprint->inner_radius_m() : robot.radius_m) {}

  [[nodiscard]] bool is_clear(const Station& at) const {
    const OccupancyMap& map = checker_.map();
    if (!map.contains(map.cell_at(at.position_m))) return false;
    if (footprint_ && at.yaw_rad) return footprint_->is_clear(map, {at.position_m, *at.yaw_rad});
    const Vec2 in_grid = inverse(map.map_from_grid) * at.position_m / map.resolution_m;
    return checker_.along(in_grid, in_grid);
  }

 private:
  std::optional<Footprint> footprint_;
  CollisionChecker checker_;
};

std::string words_for(const KeepOut& zone, std::size_t number) {
  return zone.name.empty() ? fmt::format("keep-out {}", number + 1) : "keep-out '" + zone.name + "'";
}

/// The keep-out nearest to a point.
std::string keep_out_at(const Places& places, const Vec2& position_m) {
  const auto distance_m = [&](const KeepOut& zone) { return distance_to(zone.corners_m, position_m); };
  const auto nearest = std::ranges::min_element(places.keep_out, {}, distance_m);
  return words_for(*nearest, static_cast<std::size_t>(nearest - places.keep_out.begin()));
}

/// The stations where the robot can stand; the others become issues.
std::vector<Station> standing(const Site& site, std::vector<PlacesIssue>& issues) {
  const Standing on_map(site.map.map, site.robot);
  const Standing on_drivable(drivable_map(site), site.robot);
  std::vector<Station> good;
  for (const Station& at : stations_of(site)) {
    if (on_drivable.is_clear(at)) {
      good.push_back(at);
    } else if (on_map.is_clear(at)) {
      issues.push_back({PlacesIssueKind::in_keep_out,
                        true,
                        fmt::format("{} stands in {}", at.name, keep_out_at(site.places, at.position_m)),
                        {at.position_m}});
    } else {
      issues.push_back({PlacesIssueKind::in_obstacle,
                        true,
                        fmt::format("{} stands in an obstacle or beside the map", at.name),
                        {at.position_m}});
    }
  }
  return good;
}

/// Stations that reach each other, the largest group first.
std::vector<std::vector<Station>> groups_of(const std::vector<Station>& stations,
                                            const MarginPlanner& planner) {
  std::vector<std::vector<Station>> groups;
  for (const Station& at : stations) {
    const auto reaches = [&](const std::vector<Station>& group) {
      const PlanHeadings headings{.start_rad = group.front().yaw_rad, .goal_rad = at.yaw_rad};
      return std::holds_alternative<Plan>(planner.plan(group.front().position_m, at.position_m, headings));
    };
    const auto group = std::ranges::find_if(groups, reaches);
    if (group == groups.end()) {
      groups.push_back({at});
    } else {
      group->push_back(at);
    }
  }
  std::ranges::stable_sort(groups, std::greater{}, &std::vector<Station>::size);
  return groups;
}

void find_unreachable(const std::vector<Station>& stations, const MarginPlanner& planner,
                      std::vector<PlacesIssue>& issues) {
  const std::vector<std::vector<Station>> groups = groups_of(stations, planner);
  for (std::size_t i = 1; i < groups.size(); ++i) {
    for (const Station& at : groups[i])
      issues.push_back({PlacesIssueKind::unreachable,
                        true,
                        fmt::format("{} cannot be reached from {}", at.name, groups[0].front().name),
                        {at.position_m}});
  }
}

void find_blocked_edges(const Site& site, const MarginPlanner& planner, std::vector<PlacesIssue>& issues) {
  std::optional<MarginPlanner> on_map;  // without the keep-outs
  for (const RouteEdge& edge : site.places.edges) {
    const Vec2 from_m = site.places.position_m(edge.from).value();
    const Vec2 to_m = site.places.position_m(edge.to).value();
    if (planner.is_clear(from_m, to_m)) continue;
    if (!on_map) on_map.emplace(site.map.map, navigation_options(site.robot).planner);
    issues.push_back({PlacesIssueKind::blocked_edge,
                      true,
                      fmt::format("the edge from '{}' to '{}' is blocked by {}", edge.from, edge.to,
                                  on_map->is_clear(from_m, to_m) ? "a keep-out" : "an obstacle"),
                      {from_m, to_m}});
  }
}

void find_lonely_nodes(const Places& places, std::vector<PlacesIssue>& issues) {
  for (const RouteNode& node : places.nodes) {
    const bool has_edge = std::ranges::any_of(
        places.edges, [&](const RouteEdge& edge) { return edge.from == node.name || edge.to == node.name; });
    if (!has_edge)
      issues.push_back({PlacesIssueKind::lonely_node,
                        false,
                        fmt::format("no edge leads to the node '{}'", node.name),
                        {node.position_m}});
  }
}

/// One-way edges may lead from a place, but not back.
void find_unreachable_by_edges(const Site& site, std::vector<PlacesIssue>& issues) {
  const Places& places = site.places;
  const RouteGraph graph(places, site.robot.max_forward_mps);
  for (const Place& from : places.places) {
    if (!graph.has_edge(from.name)) continue;
    for (const std::string& name : graph.unreachable_from(from.name))
      issues.push_back({PlacesIssueKind::unreachable_by_edges,
                        false,
                        fmt::format("no edges lead from '{}' to '{}'", from.name, name),
                        {places.position_m(name).value()}});
    return;
  }
}

/// Zones drawn for another map.
void find_zones_off_map(const Site& site, std::vector<PlacesIssue>& issues) {
  OccupancyMap nothing = site.map.map;
  std::ranges::fill(nothing.cells, OccupancyMap::free);
  const auto check = [&](const KeepOut& zone, const std::string& name) {
    if (std::ranges::count(with_keep_out(nothing, {&zone, 1}).cells, OccupancyMap::occupied) == 0)
      issues.push_back(
          {PlacesIssueKind::zone_off_map, false, name + " does not touch the map", zone.corners_m});
  };
  for (std::size_t i = 0; i < site.places.keep_out.size(); ++i)
    check(site.places.keep_out[i], words_for(site.places.keep_out[i], i));
  for (std::size_t i = 0; i < site.places.speed_zones.size(); ++i) {
    const SpeedZone& zone = site.places.speed_zones[i];
    check({zone.name, zone.corners_m},
          zone.name.empty() ? fmt::format("speed zone {}", i + 1) : "speed zone '" + zone.name + "'");
  }
}

/// From stop to stop, and back to the first where the mission is driven again; legs that cannot be planned
/// are left out.
std::vector<Path> ways_of(const NamedMission& mission, const Places& places, const MarginPlanner& planner) {
  std::vector<Vec2> stops_m;
  for (const MissionStop& stop : mission.stops)
    if (const auto at = places.position_m(stop.place)) stops_m.push_back(*at);
  if (mission.repeat > 1 && stops_m.size() > 1) stops_m.push_back(stops_m.front());
  std::vector<Path> ways;
  for (std::size_t i = 0; i + 1 < stops_m.size(); ++i) {
    const PlanResult planned = planner.plan(stops_m[i], stops_m[i + 1]);
    if (const auto* plan = std::get_if<Plan>(&planned)) ways.push_back(plan->path);
  }
  return ways;
}

/// Without any marker there is nothing to say of each.
void find_blind_ways(const Site& site, const CoveredFloor* known, const MarginPlanner& planner,
                     std::vector<PlacesIssue>& issues) {
  const Places& places = site.places;
  if (site.registry.markers.empty() || (places.missions.empty() && places.edges.empty())) return;
  std::optional<CoveredFloor> made;  // a large map, which is not copied
  const CoveredFloor& floor = known != nullptr ? *known : made.emplace(covered_floor(site));
  const auto look = [&](const Path& way, PlacesIssueKind kind, const std::string& name) {
    for (const BlindStretch& blind : blind_stretches_of(way, site.registry, floor))
      issues.push_back({kind,
                        false,
                        fmt::format("{} sees no marker for {:.1f} m from {:.1f}, {:.1f} m", name,
                                    blind.length_m, blind.from_m.x(), blind.from_m.y()),
                        {blind.from_m, blind.to_m}});
  };
  for (const NamedMission& mission : places.missions)
    for (const Path& way : ways_of(mission, places, planner))
      look(way, PlacesIssueKind::blind_mission, "mission '" + mission.name + "'");
  for (const RouteEdge& edge : places.edges) {
    const Path way{{places.position_m(edge.from).value(), places.position_m(edge.to).value()}};
    if (planner.is_clear(way.waypoints_m.front(), way.waypoints_m.back()))
      look(way, PlacesIssueKind::blind_edge, fmt::format("the edge from '{}' to '{}'", edge.from, edge.to));
  }
}

}  // namespace

std::string_view to_string(PlacesIssueKind kind) {
  switch (kind) {
    case PlacesIssueKind::in_obstacle:
      return "in-obstacle";
    case PlacesIssueKind::in_keep_out:
      return "in-keep-out";
    case PlacesIssueKind::unreachable:
      return "unreachable";
    case PlacesIssueKind::blocked_edge:
      return "blocked-edge";
    case PlacesIssueKind::lonely_node:
      return "lonely-node";
    case PlacesIssueKind::unreachable_by_edges:
      return "unreachable-by-edges";
    case PlacesIssueKind::zone_off_map:
      return "zone-off-map";
    case PlacesIssueKind::blind_mission:
      return "blind-mission";
    case PlacesIssueKind::blind_edge:
      return "blind-edge";
  }
  return "";
}

nlohmann::ordered_json issue_json(const PlacesIssue& issue) {
  nlohmann::ordered_json json{{"kind", to_string(issue.kind)},
                              {"severity", issue.error ? "error" : "warning"},
                              {"words", issue.words},
                              {"positions_m", nlohmann::ordered_json::array()}};
  for (const Vec2& at : issue.positions_m) json["positions_m"].push_back({at.x(), at.y()});
  return json;
}

std::vector<PlacesIssue> check_places(const Site& site, const CoveredFloor* floor) {
  std::vector<PlacesIssue> issues;
  const MarginPlanner planner(drivable_map(site), navigation_options(site.robot).planner);
  find_unreachable(standing(site, issues), planner, issues);
  find_blocked_edges(site, planner, issues);
  find_unreachable_by_edges(site, issues);
  find_lonely_nodes(site.places, issues);
  find_zones_off_map(site, issues);
  find_blind_ways(site, floor, planner, issues);
  return issues;
}

}  // namespace lodestar
