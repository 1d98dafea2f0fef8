#include "app/fleet/message_reader.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

#include "app/common/json_parse.hpp"
#include "app/common/whole_number.hpp"
#include "app/site/goal.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t most_number = 0x7FFFFFFF;

/// What is wrong; caught where the references are known.
struct Invalid {
  std::string what;
};

class Reader {
 public:
  Reader(const char* topic, const MessageLimits& limits) : limits_(limits) { refer("topic", topic); }

  /// The whole message. Fills `header`.
  Json open(std::string_view text, const MessageAddress& address, std::uint32_t& header) {
    if (text.size() > limits_.bytes)
      throw Invalid{fmt::format("{} bytes, at most {} are read", text.size(), limits_.bytes)};
    Json json = parse_json(text);
    if (!json.is_object()) throw Invalid{"no JSON object"};
    if (json.contains("headerId")) {
      header = number(json, "headerId");
      refer("headerId", std::to_string(header));
    }
    const std::string version = json.contains("version") ? this->text(json, "version", true) : "";
    if (!version.empty() && !version.starts_with("2"))
      throw Invalid{"version " + version + ", wanted 2.0.0 or 2.1.0"};
    expect_same(json, "manufacturer", address.manufacturer);
    expect_same(json, "serialNumber", address.serial);
    return json;
  }

  [[nodiscard]] std::string text(const Json& json, const char* key, bool may_be_empty = false) const {
    const auto found = json.find(key);
    if (found == json.end()) throw Invalid{fmt::format("no {}", key)};
    if (!found->is_string()) throw Invalid{fmt::format("{} is no text", key)};
    auto value = found->get<std::string>();
    if (value.size() > limits_.text_bytes)
      throw Invalid{
          fmt::format("{} has {} bytes, at most {} are read", key, value.size(), limits_.text_bytes)};
    if (value.empty() && !may_be_empty) throw Invalid{fmt::format("{} is empty", key)};
    return value;
  }

  [[nodiscard]] static std::uint32_t number(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) throw Invalid{fmt::format("no {}", key)};
    try {
      return whole_number(*found, most_number);
    } catch (const InputError&) {
      throw Invalid{fmt::format("{} is no whole number from 0 on", key)};
    }
  }

  [[nodiscard]] static bool flag(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_boolean())
      throw Invalid{fmt::format("{} is not true or false", key)};
    return found->get<bool>();
  }

  [[nodiscard]] static double real(const Json& json, const char* key, double most) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number()) throw Invalid{fmt::format("{} is no number", key)};
    const auto value = found->get<double>();
    if (!(std::abs(value) <= most))
      throw Invalid{fmt::format("{} is {}, at most {} make sense", key, value, most)};
    return value;
  }

  /// The first of these keys that is there and not null.
  [[nodiscard]] static const char* first_of(const Json& json, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
      const auto found = json.find(key);
      if (found != json.end() && !found->is_null()) return key;
    }
    return nullptr;
  }

  /// Empty where there is none.
  [[nodiscard]] static const Json& list(const Json& json, const char* key, std::size_t most) {
    static const Json none = Json::array();
    if (key == nullptr || !first_of(json, {key})) return none;
    const Json& found = json.at(key);
    if (!found.is_array()) throw Invalid{fmt::format("{} is no list", key)};
    if (found.size() > most)
      throw Invalid{fmt::format("{} {}, at most {} are read", found.size(), key, most)};
    for (const Json& item : found)
      if (!item.is_object()) throw Invalid{fmt::format("an item of {} is no object", key)};
    return found;
  }

  std::vector<FleetAction> actions(const Json& json, const char* key) {
    std::vector<FleetAction> actions;
    for (const Json& item : list(json, key, limits_.actions)) {
      FleetAction action;
      action.id = text(item, "actionId");
      const Reference here(*this, "actionId", action.id);
      const char* type = first_of(item, {"actionType", "actionName"});
      action.type = text(item, type != nullptr ? type : "actionType");
      if (!action_ids_.insert(action.id).second) throw Invalid{"an actionId twice"};
      action.blocking = blocking(item);
      for (const Json& pair : list(item, "actionParameters", limits_.parameters))
        action.parameters[text(pair, "key")] = value(pair);
      actions.push_back(std::move(action));
      here.done();
    }
    return actions;
  }

  /// A reference that holds while it lives, and after an error in it.
  class Reference {
   public:
    Reference(Reader& reader, const char* key, const std::string& value) : reader_(reader) {
      reader_.refer(key, value);
    }
    void done() const { reader_.references_.pop_back(); }

   private:
    Reader& reader_;
  };

  void refer(std::string key, std::string value) {
    references_.push_back({std::move(key), std::move(value)});
  }

  [[nodiscard]] FleetError error(const std::string& what) const {
    return {.type = vda_error::validation, .description = what, .references = references_};
  }

  [[nodiscard]] const MessageLimits& limits() const { return limits_; }

 private:
  void expect_same(const Json& json, const char* key, const std::string& wanted) const {
    if (wanted.empty() || first_of(json, {key}) == nullptr) return;
    const std::string found = text(json, key, true);
    if (!found.empty() && found != wanted) throw Invalid{fmt::format("{} is {}", key, found)};
  }

  /// A robot that is told nothing does one thing after the other.
  [[nodiscard]] static Blocking blocking(const Json& item) {
    if (first_of(item, {"blockingType"}) == nullptr) return Blocking::hard;
    const Json& word = item.at("blockingType");
    for (const Blocking one : {Blocking::none, Blocking::soft, Blocking::hard})
      if (word.is_string() && word.get_ref<const std::string&>() == to_string(one)) return one;
    throw Invalid{"blockingType is not NONE, SOFT or HARD"};
  }

  [[nodiscard]] std::string value(const Json& pair) const {
    const auto found = pair.find("value");
    if (found == pair.end()) throw Invalid{"an action parameter without a value"};
    std::string text = found->is_string() ? found->get<std::string>() : found->dump();
    if (text.size() > limits_.parameter_bytes) throw Invalid{"an action parameter is too long"};
    return text;
  }

  MessageLimits limits_;
  std::vector<ErrorReference> references_;
  std::set<std::string> action_ids_;
};

NodePosition read_position(const Reader& reader, const Json& json) {
  if (!json.is_object()) throw Invalid{"nodePosition is no object"};
  NodePosition at;
  at.position_m = {Reader::real(json, "x", far_m), Reader::real(json, "y", far_m)};
  if (Reader::first_of(json, {"theta"}))
    at.heading_rad = wrap_angle(Reader::real(json, "theta", 2.0 * std::numbers::pi));
  if (const char* key = Reader::first_of(json, {"allowedDeviationXY", "allowedDeviationXy"}))
    at.deviation_m = std::abs(Reader::real(json, key, far_m));
  if (Reader::first_of(json, {"allowedDeviationTheta"}))
    at.deviation_rad = std::abs(Reader::real(json, "allowedDeviationTheta", 2.0 * std::numbers::pi));
  if (Reader::first_of(json, {"mapId"})) at.map = reader.text(json, "mapId", true);
  return at;
}

FleetNode read_node(Reader& reader, const Json& json) {
  FleetNode node;
  node.id = reader.text(json, "nodeId");
  const Reader::Reference here(reader, "nodeId", node.id);
  node.sequence = Reader::number(json, "sequenceId");
  node.released = Reader::flag(json, "released");
  if (Reader::first_of(json, {"nodePosition"})) node.at = read_position(reader, json.at("nodePosition"));
  node.actions = reader.actions(json, "actions");
  here.done();
  return node;
}

/// Optional fields cannot be ignored (6.1.1). What only repeats what a robot does that turns on the spot and
/// then drives ahead is no demand.
std::vector<std::string> demands_in(const Json& json) {
  std::vector<std::string> demands;
  for (const char* key :
       {"maxHeight", "minHeight", "direction", "maxRotationSpeed", "trajectory", "corridor"}) {
    if (Reader::first_of(json, {key}) == nullptr) continue;
    const bool is_empty = json.at(key) == "" || json.at(key) == 0.0;
    if (!is_empty) demands.emplace_back(key);
  }
  const bool has_orientation = Reader::first_of(json, {"orientation"}) != nullptr;
  constexpr double straight_ahead_rad = 1e-3;
  if (has_orientation && std::abs(Reader::real(json, "orientation", 10.0)) > straight_ahead_rad)
    demands.emplace_back("orientation");
  const bool has_type = Reader::first_of(json, {"orientationType"}) != nullptr;
  if (has_orientation && has_type && json.at("orientationType") == "GLOBAL" && demands.empty())
    demands.emplace_back("orientationType");
  if (Reader::first_of(json, {"rotationAllowed"}) && !Reader::flag(json, "rotationAllowed"))
    demands.emplace_back("rotationAllowed");
  return demands;
}

FleetEdge read_edge(Reader& reader, const Json& json) {
  FleetEdge edge;
  edge.id = reader.text(json, "edgeId");
  const Reader::Reference here(reader, "edgeId", edge.id);
  edge.sequence = Reader::number(json, "sequenceId");
  edge.released = Reader::flag(json, "released");
  edge.from = reader.text(json, "startNodeId");
  edge.to = reader.text(json, "endNodeId");
  if (Reader::first_of(json, {"maxSpeed"})) edge.max_mps = Reader::real(json, "maxSpeed", 1000.0);
  edge.actions = reader.actions(json, "actions");
  edge.demands = demands_in(json);
  here.done();
  return edge;
}

/// A node, an edge, a node ...: numbered in turn, each edge between its neighbours, and once the horizon has
/// begun nothing more is released.
void check_chain(const FleetOrder& order) {
  if (order.nodes.empty()) throw Invalid{"no nodes"};
  if (order.edges.size() + 1 != order.nodes.size())
    throw Invalid{fmt::format("{} nodes and {} edges", order.nodes.size(), order.edges.size())};
  if (!order.nodes.front().released) throw Invalid{"the first node is not released"};
  for (std::size_t i = 0; i < order.edges.size(); ++i) {
    const FleetNode& from = order.nodes[i];
    const FleetEdge& edge = order.edges[i];
    const FleetNode& to = order.nodes[i + 1];
    if (edge.sequence != from.sequence + 1 || to.sequence != from.sequence + 2)
      throw Invalid{fmt::format("sequenceIds around edge {} do not follow each other", edge.id)};
    if (edge.from != from.id || edge.to != to.id)
      throw Invalid{fmt::format("edge {} is not between {} and {}", edge.id, from.id, to.id)};
    if (edge.released != to.released || (to.released && !from.released))
      throw Invalid{fmt::format("edge {} or its end is released, what comes before it is not", edge.id)};
  }
}

FleetOrder read_order_by(Reader& reader, std::string_view text, const MessageAddress& address) {
  FleetOrder order;
  const Json json = reader.open(text, address, order.header);
  order.id = reader.text(json, "orderId");
  reader.refer("orderId", order.id);
  order.update = Reader::number(json, "orderUpdateId");
  reader.refer("orderUpdateId", std::to_string(order.update));
  if (Reader::first_of(json, {"zoneSetId"})) order.zone_set = reader.text(json, "zoneSetId", true);
  for (const Json& node : Reader::list(json, "nodes", reader.limits().nodes))
    order.nodes.push_back(read_node(reader, node));
  for (const Json& edge : Reader::list(json, "edges", reader.limits().nodes))
    order.edges.push_back(read_edge(reader, edge));
  std::ranges::sort(order.nodes, {}, &FleetNode::sequence);
  std::ranges::sort(order.edges, {}, &FleetEdge::sequence);
  check_chain(order);
  return order;
}

InstantActions read_actions_by(Reader& reader, std::string_view text, const MessageAddress& address) {
  InstantActions message;
  const Json json = reader.open(text, address, message.header);
  const char* key = Reader::first_of(json, {"actions", "instantActions"});
  if (key == nullptr) throw Invalid{"no actions"};
  message.actions = reader.actions(json, key);
  return message;
}

/// The parser repeats what it read, which may be long and anything but text.
std::string printable(std::string_view words) {
  constexpr std::size_t most = 160;
  std::string text(words.substr(0, most));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

template <typename Read>
FleetMessage read_by(Reader reader, const Read& read) {
  try {
    return read(reader);
  } catch (const Invalid& invalid) {
    return reader.error(invalid.what);
  } catch (const InputError& error) {
    return reader.error(printable(error.what()));
  }
}

}  // namespace

FleetMessage read_order(std::string_view text, const MessageAddress& address, const MessageLimits& limits) {
  return read_by(Reader("order", limits),
                 [&](Reader& reader) { return read_order_by(reader, text, address); });
}

FleetMessage read_instant_actions(std::string_view text, const MessageAddress& address,
                                  const MessageLimits& limits) {
  return read_by(Reader("instantActions", limits),
                 [&](Reader& reader) { return read_actions_by(reader, text, address); });
}

}  // namespace lodestar
