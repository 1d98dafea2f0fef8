#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "maps/input_error.hpp"
#include "maps/places.hpp"
#include "maps/strict_yaml.hpp"
#include "maps/tidy.hpp"
#include "maps/yaml_quoting.hpp"

namespace lodestar {
namespace {

constexpr double greatest_m = 1e5;    // no indoor site is this large: a mistake of units
constexpr double slowest_mps = 0.02;  // what motors with a usual dead band can drive at
constexpr double fastest_mps = 5.0;
constexpr std::size_t longest_name = 80;
constexpr std::size_t most_corners = 1000;

using Names = std::set<std::string>;

/// "1,2,90" given for a goal is a point and a heading, not a name.
bool looks_like_a_point(const std::string& name) {
  return name.find(',') != std::string::npos &&
         name.find_first_not_of("0123456789.,+-eE") == std::string::npos;
}

/// Text that YAML can hold as it is: no control characters, nothing but UTF-8.
bool is_text(const std::string& name) {
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7f; }))
    return false;
  try {
    return YAML::Load(yaml_quoted(name)).Scalar() == name;
  } catch (const YAML::Exception&) {
    return false;
  }
}

std::string read_name(StrictYaml& yaml, Names& taken) {
  std::string name = yaml.text("name");
  if (name.size() > longest_name || !is_text(name)) {
    yaml.refuse("name", fmt::format("a name of {} bytes", name.size()),
                fmt::format("1 to {} bytes of plain text", longest_name));
  }
  if (looks_like_a_point(name)) yaml.refuse("name", "'" + name + "'", "a name that is no pair of numbers");
  if (!taken.insert(name).second) yaml.refuse("name", "'" + name + "' twice", "each name once");
  return name;
}

std::string read_name_if_any(StrictYaml& yaml, Names& taken) {
  return yaml.has("name") ? read_name(yaml, taken) : "";
}

/// Rounded as it is written: what is checked here is what will be read again.
Vec2 read_point(StrictYaml& yaml) {
  const double x_m = yaml.number("x_m", -greatest_m, greatest_m);
  const double y_m = yaml.number("y_m", -greatest_m, greatest_m);
  return {tidy(x_m), tidy(y_m)};
}

Place read_place(StrictYaml& yaml, Names& taken) {
  Place place{.name = read_name(yaml, taken), .position_m = read_point(yaml), .yaw_rad = std::nullopt};
  if (yaml.has("yaw_deg")) place.yaw_rad = wrap_angle(radians(yaml.number("yaw_deg", -360.0, 360.0)));
  return place;
}

std::string read_end(StrictYaml& yaml, const std::string& key, const Names& known) {
  std::string name = yaml.text(key);
  if (!known.contains(name)) yaml.refuse(key, "'" + name + "'", "the name of a place or a node");
  return name;
}

/// A way that may be driven both ways is the same as the one back.
RouteEdge read_edge(StrictYaml& yaml, const Names& known,
                    std::set<std::pair<std::string, std::string>>& ways) {
  RouteEdge edge{.from = read_end(yaml, "from", known),
                 .to = read_end(yaml, "to", known),
                 .one_way = yaml.has("one_way") && yaml.boolean("one_way"),
                 .max_mps = std::nullopt};
  if (yaml.has("max_mps")) edge.max_mps = yaml.number("max_mps", slowest_mps, fastest_mps);
  if (edge.from == edge.to) yaml.refuse("to", "'" + edge.to + "', where it begins", "another end");
  const bool is_new = ways.emplace(edge.from, edge.to).second;
  const bool is_new_back = edge.one_way || ways.emplace(edge.to, edge.from).second;
  if (!is_new || !is_new_back)
    yaml.refuse("to", fmt::format("'{}' to '{}' twice", edge.from, edge.to), "each way once");
  return edge;
}

Polygon read_corners(StrictYaml& yaml) {
  const std::string key = "corners_m";
  Polygon corners_m = yaml.points(key, greatest_m);
  if (corners_m.size() < 3 || corners_m.size() > most_corners)
    yaml.refuse(key, fmt::format("{} corners", corners_m.size()), fmt::format("3 to {}", most_corners));
  for (Vec2& corner : corners_m) corner = {tidy(corner.x()), tidy(corner.y())};
  const Polygon other_way(corners_m.rbegin(), corners_m.rend());
  if (!is_simple(corners_m) && !is_simple(other_way))
    yaml.refuse(key, fmt::format("{} corners of no polygon", corners_m.size()),
                "a polygon that goes around once without touching or crossing itself");
  return corners_m;
}

std::string read_place_name(const StrictYaml& yaml, const YAML::Node& entry, const Places& places) {
  std::string name = entry.IsScalar() ? entry.Scalar() : "";
  if (places.find(name) == nullptr) yaml.refuse_at(entry, "'" + name + "'", "the name of a place");
  return name;
}

/// A type of action as site.yaml and VDA 5050 write it.
std::string read_action(StrictYaml& yaml) {
  std::string action = yaml.text("action");
  if (action.empty() || action.size() > longest_name || !is_text(action))
    yaml.refuse("action", fmt::format("a name of {} bytes", action.size()),
                fmt::format("1 to {} bytes of plain text", longest_name));
  return action;
}

MissionStop read_stop(StrictYaml& yaml, const Places& places) {
  constexpr double longest_wait_s = 86400.0;
  MissionStop stop{.place = read_place_name(yaml, yaml.node("place"), places), .action = {}};
  if (yaml.has("wait_s")) stop.wait_s = tidy(yaml.number("wait_s", 0.0, longest_wait_s));
  if (yaml.has("action")) stop.action = read_action(yaml);
  yaml.finish();
  return stop;
}

/// `places`: names alone; `stops`: with what is done there.
NamedMission read_mission(StrictYaml& yaml, Names& taken, const Places& places) {
  NamedMission mission{.name = read_name(yaml, taken), .stops = {}};
  if (yaml.has("stops")) {
    for (StrictYaml& stop : yaml.list_of_mappings("stops")) mission.stops.push_back(read_stop(stop, places));
    if (mission.stops.empty()) yaml.refuse("stops", "none", "stops at places");
  } else {
    const YAML::Node list = yaml.node("places");
    if (!list.IsSequence() || list.size() == 0) yaml.refuse("places", "none", "names of places");
    for (const YAML::Node& entry : list)
      mission.stops.push_back({.place = read_place_name(yaml, entry, places), .action = {}});
  }
  const auto count = static_cast<int>(mission.stops.size());
  if (count > NamedMission::most_goals)
    yaml.refuse("name", fmt::format("{} stops", count), fmt::format("at most {}", NamedMission::most_goals));
  if (yaml.has("repeat")) mission.repeat = yaml.integer("repeat", 1, NamedMission::most_goals / count);
  return mission;
}

void expect_kind(StrictYaml& yaml, const std::string& format) {
  const std::string found = yaml.text("format");
  if (found != format) yaml.refuse("format", "'" + found + "'", "'" + format + "'");
  (void)yaml.integer("version", 1, 1);
}

/// The items of a list, each read whole.
template <typename Read>
auto read_list(StrictYaml& yaml, const std::string& key, const Read& read) {
  std::vector<decltype(read(yaml))> items;
  for (StrictYaml& entry : yaml.list_of_mappings(key)) {
    items.push_back(read(entry));
    entry.finish();
  }
  return items;
}

/// The same where the list may be missing.
template <typename Read>
auto read_list_if_any(StrictYaml& yaml, const std::string& key, const Read& read) {
  return yaml.has(key) ? read_list(yaml, key, read) : std::vector<decltype(read(yaml))>{};
}

Places read_places(StrictYaml yaml) {
  expect_kind(yaml, "lodestar-places");
  Places places;
  Names points;
  Names keep_outs;
  Names speed_zones;
  Names missions;
  std::set<std::pair<std::string, std::string>> ways;
  places.places = read_list(yaml, "places", [&](StrictYaml& item) { return read_place(item, points); });
  places.nodes = read_list_if_any(yaml, "nodes", [&](StrictYaml& item) {
    return RouteNode{.name = read_name(item, points), .position_m = read_point(item)};
  });
  places.edges =
      read_list_if_any(yaml, "edges", [&](StrictYaml& item) { return read_edge(item, points, ways); });
  places.keep_out = read_list_if_any(yaml, "keep_out", [&](StrictYaml& item) {
    return KeepOut{.name = read_name_if_any(item, keep_outs), .corners_m = read_corners(item)};
  });
  places.speed_zones = read_list_if_any(yaml, "speed_zones", [&](StrictYaml& item) {
    return SpeedZone{.name = read_name_if_any(item, speed_zones),
                     .corners_m = read_corners(item),
                     .max_mps = item.number("max_mps", slowest_mps, fastest_mps)};
  });
  places.missions = read_list_if_any(yaml, "missions",
                                     [&](StrictYaml& item) { return read_mission(item, missions, places); });
  yaml.finish();
  return places;
}

Places read_routes(StrictYaml yaml) {
  expect_kind(yaml, "lodestar-routes");
  Places places;
  Names points;
  Names missions;
  places.places = read_list(yaml, "places", [&](StrictYaml& item) { return read_place(item, points); });
  places.missions =
      read_list(yaml, "routes", [&](StrictYaml& item) { return read_mission(item, missions, places); });
  yaml.finish();
  return places;
}

}  // namespace

Places parse_places(const std::string& text, const std::filesystem::path& file) {
  return read_places(StrictYaml::parse(text, file));
}

Places parse_routes(const std::string& text, const std::filesystem::path& file) {
  return read_routes(StrictYaml::parse(text, file));
}

Places load_places(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / places_file_name;
  const std::filesystem::path older = folder / older_places_file_name;
  if (std::filesystem::exists(file)) return read_places(StrictYaml::load(file));
  return std::filesystem::exists(older) ? read_routes(StrictYaml::load(older)) : Places{};
}

}  // namespace lodestar
