#include "app/console/places_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <vector>

#include "app/common/json_parse.hpp"
#include "app/site/places_limits.hpp"
#include "maps/input_error.hpp"
#include "maps/tidy.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* sent_name = "sent";  ///< stands for the file in error messages

ordered_json point_json(const std::string& name, const Vec2& position_m) {
  return {{"name", name}, {"x_m", position_m.x()}, {"y_m", position_m.y()}};
}

ordered_json zone_json(const std::string& name, const Polygon& corners_m) {
  ordered_json zone = ordered_json::object();
  if (!name.empty()) zone["name"] = name;
  zone["corners_m"] = ordered_json::array();
  for (const Vec2& corner : corners_m) zone["corners_m"].push_back({corner.x(), corner.y()});
  return zone;
}

ordered_json item_json(const Place& place) {
  ordered_json item = point_json(place.name, place.position_m);
  if (place.yaw_rad) item["yaw_deg"] = tidy(degrees(*place.yaw_rad));
  return item;
}

ordered_json item_json(const RouteNode& node) {
  return point_json(node.name, node.position_m);
}

ordered_json item_json(const RouteEdge& edge) {
  ordered_json item{{"from", edge.from}, {"to", edge.to}};
  if (edge.one_way) item["one_way"] = true;
  if (edge.max_mps) item["max_mps"] = *edge.max_mps;
  return item;
}

ordered_json item_json(const KeepOut& zone) {
  return zone_json(zone.name, zone.corners_m);
}

ordered_json item_json(const SpeedZone& zone) {
  ordered_json item = zone_json(zone.name, zone.corners_m);
  item["max_mps"] = zone.max_mps;
  return item;
}

ordered_json item_json(const NamedMission& mission) {
  return mission_json(mission);
}

template <typename Item>
ordered_json list_json(const std::vector<Item>& items) {
  ordered_json list = ordered_json::array();
  for (const Item& item : items) list.push_back(item_json(item));
  return list;
}

/// Where an item of the document stands when it is printed one item a line.
struct PrintedItem {
  std::string list;
  std::size_t index = 0;
};

/// The document with each item on a line of its own, so that an error's line tells the item.
struct PrintedDocument {
  std::string text = "{\n";
  std::vector<PrintedItem> lines{{}, {}};  ///< by line number; those without an item are empty

  void add(const std::string& text_of_line, const PrintedItem& item) {
    text += text_of_line + "\n";
    lines.push_back(item);
  }
};

PrintedDocument one_item_a_line(const json& document) {
  PrintedDocument printed;
  std::size_t rest = document.size();
  for (const auto& [key, value] : document.items()) {
    const std::string comma = --rest > 0 ? "," : "";
    if (!value.is_array()) {
      printed.add(json(key).dump() + ": " + value.dump() + comma, {});
      continue;
    }
    printed.add(json(key).dump() + ": [", {});
    for (std::size_t i = 0; i < value.size(); ++i)
      printed.add(value[i].dump() + (i + 1 < value.size() ? "," : ""), {key, i});
    printed.add("]" + comma, {});
  }
  printed.text += "}\n";
  return printed;
}

/// Of "sent:12: found ..."; 0 without one.
std::size_t line_in(const std::string& words) {
  const std::string begin = std::string(sent_name) + ":";
  std::size_t line = 0;
  if (words.starts_with(begin))
    std::from_chars(words.data() + begin.size(), words.data() + words.size(), line);
  return line;
}

PlacesRefusal refusal_of(const InputError& error, const PrintedDocument& document) {
  const std::string words = error.what();
  const std::size_t line = line_in(words);
  const PrintedItem item = line < document.lines.size() ? document.lines[line] : PrintedItem{};
  const std::size_t reason = words.find(": ");
  return {reason == std::string::npos ? words : words.substr(reason + 2), item.list, item.index};
}

}  // namespace

ordered_json mission_json(const NamedMission& mission) {
  ordered_json places = ordered_json::array();
  ordered_json stops = ordered_json::array();
  bool is_plain = true;
  for (const MissionStop& stop : mission.stops) {
    places.push_back(stop.place);
    ordered_json item{{"place", stop.place}};
    if (stop.wait_s > 0.0) item["wait_s"] = stop.wait_s;
    if (!stop.action.empty()) item["action"] = stop.action;
    is_plain = is_plain && item.size() == 1;
    stops.push_back(std::move(item));
  }
  ordered_json json{{"name", mission.name}};
  json.update(is_plain ? ordered_json{{"places", places}} : ordered_json{{"stops", stops}});
  if (mission.repeat > 1) json["repeat"] = mission.repeat;
  return json;
}

ordered_json places_json(const Places& places) {
  return {{"format", "lodestar-places"},
          {"version", 1},
          {"places", list_json(places.places)},
          {"nodes", list_json(places.nodes)},
          {"edges", list_json(places.edges)},
          {"keep_out", list_json(places.keep_out)},
          {"speed_zones", list_json(places.speed_zones)},
          {"missions", list_json(places.missions)}};
}

ordered_json refusal_json(const PlacesRefusal& refusal) {
  ordered_json json{{"error", refusal.words}};
  if (!refusal.list.empty()) json.update({{"list", refusal.list}, {"index", refusal.index}});
  return json;
}

std::variant<Places, PlacesRefusal> places_from_json(const std::string& document, const Robot& robot) {
  PrintedDocument sent;
  try {
    const json read = parse_json(document);
    if (!read.is_object()) return PlacesRefusal{"found no object, wanted the lists of places.yaml", "", 0};
    sent = one_item_a_line(read);
    Places places = parse_places(sent.text, sent_name);
    if (const std::optional<TooSlow> slow = first_too_slow(places, robot))
      return PlacesRefusal{fmt::format("found {}, wanted {}", slow->found, slow->wanted), slow->list,
                           slow->index};
    return places;
  } catch (const InputError& error) {
    return refusal_of(error, sent);
  } catch (const json::exception& error) {
    return PlacesRefusal{error.what(), "", 0};
  }
}

}  // namespace lodestar
