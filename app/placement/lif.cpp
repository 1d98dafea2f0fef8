#include "app/placement/lif.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

#include "app/common/json_parse.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json node_json(const std::string& id, const Vec2& position_m, const std::optional<double>& yaw_rad,
                       const LifHeader& header) {
  ordered_json properties{{"vehicleTypeId", header.vehicle_type}};
  if (yaw_rad) properties["theta"] = *yaw_rad;
  return {{"nodeId", id},
          {"mapId", header.project},
          {"nodePosition", {{"x", position_m.x()}, {"y", position_m.y()}}},
          {"vehicleTypeNodeProperties", ordered_json::array({properties})}};
}

/// The robot turns at the nodes and drives forward between them.
ordered_json edge_json(const std::string& from, const std::string& to, const std::optional<double>& max_mps,
                       const LifHeader& header) {
  ordered_json properties{{"vehicleTypeId", header.vehicle_type},
                          {"vehicleOrientation", 0.0},
                          {"orientationType", "TANGENTIAL"},
                          {"rotationAllowed", false}};
  if (max_mps) properties["maxSpeed"] = *max_mps;
  return {{"edgeId", fmt::format("{} to {}", from, to)},
          {"startNodeId", from},
          {"endNodeId", to},
          {"vehicleTypeEdgeProperties", ordered_json::array({properties})}};
}

/// The layout that was chosen, or the only one.
const json& layout_of(const json& root, const std::string& chosen, const std::filesystem::path& file) {
  std::vector<std::string> ids;
  for (const json& layout : root.at("layouts")) {
    ids.push_back(layout.at("layoutId").get<std::string>());
    if (ids.back() == chosen) return layout;
  }
  if (chosen.empty() && ids.size() == 1) return root.at("layouts").front();
  throw InputError(file, 0, fmt::format("layouts '{}'", fmt::join(ids, "', '")),
                   chosen.empty() ? "one, or --layout to choose" : "'" + chosen + "'");
}

/// Of the vehicle type that was chosen, or the first; null where there is none.
const json* properties_of(const json& item, const char* key, const std::string& vehicle_type) {
  for (const json& properties : item.at(key))
    if (vehicle_type.empty() || properties.at("vehicleTypeId") == vehicle_type) return &properties;
  return nullptr;
}

/// Reads one layout.
class LifReader {
 public:
  LifReader(const json& layout, const LifChoice& choice) : choice_(choice) {
    for (const json& station : layout.at("stations"))
      for (const json& id : station.at("interactionNodeIds")) worked_at_.insert(id.get<std::string>());
    for (const json& node : layout.at("nodes")) read_node(node);
    for (const json& edge : layout.at("edges")) read_edge(edge);
  }

  ImportedLif read;

 private:
  void read_node(const json& node) {
    const auto id = node.at("nodeId").get<std::string>();
    const json* const properties = properties_of(node, "vehicleTypeNodeProperties", choice_.vehicle_type);
    if (properties == nullptr) return warn("node", id, "is not for this vehicle type");
    const json& at = node.at("nodePosition");
    const Vec2 position_m(at.at("x").get<double>(), at.at("y").get<double>());
    known_.insert(id);
    if (!worked_at_.contains(id)) {
      read.places.nodes.push_back({id, position_m});
      return;
    }
    Place place{.name = id, .position_m = position_m, .yaw_rad = std::nullopt};
    if (properties->contains("theta")) place.yaw_rad = wrap_angle(properties->at("theta").get<double>());
    read.places.places.push_back(place);
  }

  void read_edge(const json& edge) {
    const auto id = edge.at("edgeId").get<std::string>();
    const json* const properties = properties_of(edge, "vehicleTypeEdgeProperties", choice_.vehicle_type);
    if (properties == nullptr) return warn("edge", id, "is not for this vehicle type");
    const auto from = edge.at("startNodeId").get<std::string>();
    const auto to = edge.at("endNodeId").get<std::string>();
    if (!known_.contains(from) || !known_.contains(to)) return warn("edge", id, "leads out of the layout");
    if (properties->contains("trajectory")) warn("edge", id, "is a curve, taken as a straight line");
    RouteEdge way{.from = from, .to = to, .one_way = true, .max_mps = std::nullopt};
    if (properties->contains("maxSpeed")) way.max_mps = properties->at("maxSpeed").get<double>();
    add(way);
  }

  /// A way and the same way back are one edge.
  void add(const RouteEdge& way) {
    std::vector<RouteEdge>& edges = read.places.edges;
    const auto back = std::ranges::find_if(edges, [&](const RouteEdge& edge) {
      return edge.one_way && edge.from == way.to && edge.to == way.from && edge.max_mps == way.max_mps;
    });
    if (back == edges.end()) {
      edges.push_back(way);
    } else {
      back->one_way = false;
    }
  }

  void warn(const char* what, const std::string& id, const char* words) {
    read.warnings.push_back(fmt::format("{} '{}' {}", what, id, words));
  }

  LifChoice choice_;
  std::set<std::string> worked_at_;
  std::set<std::string> known_;
};

json lif_json(const std::string& text, const std::filesystem::path& file) {
  try {
    return parse_json(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

ordered_json lif_of(const Places& places, const LifHeader& header) {
  ordered_json nodes = ordered_json::array();
  ordered_json edges = ordered_json::array();
  ordered_json stations = ordered_json::array();
  for (const Place& place : places.places) {
    nodes.push_back(node_json(place.name, place.position_m, place.yaw_rad, header));
    stations.push_back(
        {{"stationId", place.name}, {"interactionNodeIds", ordered_json::array({place.name})}});
  }
  for (const RouteNode& node : places.nodes)
    nodes.push_back(node_json(node.name, node.position_m, std::nullopt, header));
  for (const RouteEdge& edge : places.edges) {
    edges.push_back(edge_json(edge.from, edge.to, edge.max_mps, header));
    if (!edge.one_way) edges.push_back(edge_json(edge.to, edge.from, edge.max_mps, header));
  }
  const ordered_json layout{{"layoutId", header.project},
                            {"layoutVersion", "1"},
                            {"nodes", nodes},
                            {"edges", edges},
                            {"stations", stations}};
  return {{"metaInformation",
           {{"projectIdentification", header.project},
            {"creator", "Lodestar"},
            {"exportTimestamp", header.exported_at},
            {"lifVersion", "1.0.0"}}},
          {"layouts", ordered_json::array({layout})}};
}

ImportedLif read_lif(const std::string& text, const std::filesystem::path& file, const LifChoice& choice) {
  try {
    const json root = lif_json(text, file);
    ImportedLif read = LifReader(layout_of(root, choice.layout, file), choice).read;
    // Reading what would be written checks it.
    read.places = parse_places(places_text(read.places), file.string() + " as places.yaml");
    return read;
  } catch (const json::exception& error) {
    throw InputError(file, 0, error.what(), "the keys and values of LIF 1.0.0");
  }
}

}  // namespace lodestar
