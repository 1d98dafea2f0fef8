#include "maps/places.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/tidy.hpp"
#include "maps/yaml_quoting.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

std::string position_text(const Vec2& position_m) {
  return fmt::format("x_m: {}, y_m: {}", tidy(position_m.x()), tidy(position_m.y()));
}

std::string line_of(const Place& place) {
  const std::string yaw = place.yaw_rad ? fmt::format(", yaw_deg: {}", tidy(degrees(*place.yaw_rad))) : "";
  return fmt::format("name: {}, {}{}", yaml_quoted(place.name), position_text(place.position_m), yaw);
}

std::string line_of(const RouteNode& node) {
  return fmt::format("name: {}, {}", yaml_quoted(node.name), position_text(node.position_m));
}

std::string line_of(const RouteEdge& edge) {
  const std::string limit = edge.max_mps ? fmt::format(", max_mps: {}", *edge.max_mps) : "";
  return fmt::format("from: {}, to: {}{}{}", yaml_quoted(edge.from), yaml_quoted(edge.to),
                     edge.one_way ? ", one_way: true" : "", limit);
}

std::string zone_text(const std::string& name, const Polygon& corners_m) {
  std::string corners;
  for (const Vec2& corner : corners_m)
    corners += fmt::format("{}[{}, {}]", corners.empty() ? "" : ", ", tidy(corner.x()), tidy(corner.y()));
  return fmt::format("{}corners_m: [{}]", name.empty() ? "" : "name: " + yaml_quoted(name) + ", ", corners);
}

std::string line_of(const KeepOut& zone) {
  return zone_text(zone.name, zone.corners_m);
}

std::string line_of(const SpeedZone& zone) {
  return fmt::format("{}, max_mps: {}", zone_text(zone.name, zone.corners_m), zone.max_mps);
}

std::string text_of(const MissionStop& stop) {
  std::string text = "{place: " + yaml_quoted(stop.place);
  if (stop.wait_s > 0.0) text += fmt::format(", wait_s: {}", tidy(stop.wait_s));
  if (!stop.action.empty()) text += ", action: " + yaml_quoted(stop.action);
  return text + "}";
}

/// Names alone, where nothing is done at the stops.
std::string line_of(const NamedMission& mission) {
  const bool is_plain = std::ranges::all_of(mission.stops, [](const MissionStop& stop) {
    return stop == MissionStop{.place = stop.place, .action = {}};
  });
  std::string stops;
  for (const MissionStop& stop : mission.stops)
    stops += (stops.empty() ? "" : ", ") + (is_plain ? yaml_quoted(stop.place) : text_of(stop));
  return fmt::format("name: {}, {}: [{}]{}", yaml_quoted(mission.name), is_plain ? "places" : "stops", stops,
                     mission.repeat > 1 ? fmt::format(", repeat: {}", mission.repeat) : "");
}

template <typename Item>
std::string list_text(const std::string& key, const std::vector<Item>& items) {
  std::string text = key + (items.empty() ? ": []\n" : ":\n");
  for (const Item& item : items) text += "  - {" + line_of(item) + "}\n";
  return text;
}

}  // namespace

const Place* Places::find(const std::string& name) const {
  const auto found = std::ranges::find(places, name, &Place::name);
  return found == places.end() ? nullptr : &*found;
}

std::optional<Vec2> Places::position_m(const std::string& name) const {
  if (const Place* const place = find(name)) return place->position_m;
  const auto node = std::ranges::find(nodes, name, &RouteNode::name);
  return node == nodes.end() ? std::nullopt : std::optional(node->position_m);
}

std::string places_text(const Places& places) {
  return "format: lodestar-places\nversion: 1\n" + list_text("places", places.places) +
         list_text("nodes", places.nodes) + list_text("edges", places.edges) +
         list_text("keep_out", places.keep_out) + list_text("speed_zones", places.speed_zones) +
         list_text("missions", places.missions);
}

/// The old file goes last: whenever this is interrupted, a file that is loaded has everything.
void save_places(const Places& places, const fs::path& folder) {
  write_file_atomically(folder / places_file_name, places_text(places));
  const fs::path older = folder / older_places_file_name;
  const fs::path kept = folder / (std::string(older_places_file_name) + ".old");
  std::error_code failed;
  if (!fs::exists(older) || fs::exists(kept)) return;
  fs::rename(older, kept, failed);
  if (failed) throw InputError(older, 0, "a file that cannot be renamed", "one to keep as routes.yaml.old");
}

}  // namespace lodestar
