#include "app/fleet/message_writer.hpp"

#include <chrono>
#include <cmath>
#include <fmt/chrono.h>
#include <numbers>

#include "app/common/json_text.hpp"
#include "app/fleet/message_reader.hpp"
#include "maps/footprint.hpp"

namespace lodestar {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson opened(const MessageHeader& header) {
  return {{"headerId", header.number},
          {"timestamp", header.timestamp},
          {"version", to_string(header.version)},
          {"manufacturer", header.manufacturer},
          {"serialNumber", header.serial}};
}

/// What a master sent may come back in a message; a byte that is no UTF-8 is replaced.
std::string text_of(const OrderedJson& json) {
  return json_text(json);
}

/// 2.0.0 wants a heading in a node's position, though orders need none: such positions are left out.
OrderedJson node_state(const FleetNode& node, VdaVersion version) {
  OrderedJson json{{"nodeId", node.id}, {"sequenceId", node.sequence}, {"released", node.released}};
  const bool may_be_without_heading = version != VdaVersion::v2_0_0;
  if (!node.at || (!node.at->heading_rad && !may_be_without_heading)) return json;
  OrderedJson& position = json["nodePosition"];
  position = {{"x", node.at->position_m.x()}, {"y", node.at->position_m.y()}, {"mapId", node.at->map}};
  if (node.at->heading_rad) position["theta"] = *node.at->heading_rad;
  return json;
}

OrderedJson action_state(const ActionRecord& record) {
  OrderedJson json{{"actionId", record.action.id},
                   {"actionType", record.action.type},
                   {"actionStatus", to_string(record.status)}};
  if (!record.result.empty()) json["resultDescription"] = record.result;
  return json;
}

OrderedJson error_state(const FleetError& error) {
  OrderedJson references = OrderedJson::array();
  for (const ErrorReference& one : error.references)
    references.push_back({{"referenceKey", one.key}, {"referenceValue", one.value}});
  return {{"errorType", error.type},
          {"errorLevel", to_string(error.level)},
          {"errorDescription", error.description},
          {"errorReferences", std::move(references)}};
}

OrderedJson position_state(const FleetReport& report) {
  return {{"x", report.map_from_base->position_m.x()},
          {"y", report.map_from_base->position_m.y()},
          {"theta", wrap_angle(report.map_from_base->yaw_rad)},
          {"mapId", report.map},
          {"positionInitialized", true},
          {"deviationRange", report.deviation_m}};
}

template <typename List, typename Write>
OrderedJson array_of(const List& list, const Write& write) {
  OrderedJson array = OrderedJson::array();
  for (const auto& item : list) array.push_back(write(item));
  return array;
}

OrderedJson offered(const char* type, std::vector<const char*> scopes,
                    OrderedJson parameters = OrderedJson::array()) {
  OrderedJson json{{"actionType", type}, {"actionScopes", std::move(scopes)}};
  if (!parameters.empty()) json["actionParameters"] = std::move(parameters);
  return json;
}

OrderedJson parameter(const char* key, const char* type, bool is_optional = false) {
  return {{"key", key}, {"valueDataType", type}, {"isOptional", is_optional}};
}

OrderedJson actions_offered(const Factsheet& facts) {
  OrderedJson actions = OrderedJson::array(
      {offered("startPause", {"INSTANT"}), offered("stopPause", {"INSTANT"}),
       offered("cancelOrder", {"INSTANT"}),
       offered("initPosition", {"INSTANT"},
               OrderedJson::array({parameter("x", "NUMBER"), parameter("y", "NUMBER"),
                                   parameter("theta", "NUMBER"), parameter("mapId", "STRING", true),
                                   parameter("lastNodeId", "STRING", true)})),
       offered("stateRequest", {"INSTANT"}), offered("factsheetRequest", {"INSTANT"}),
       offered("wait", {"NODE"}, OrderedJson::array({parameter("seconds", "NUMBER")}))});
  if (facts.charges)
    for (const char* type : {"startCharging", "stopCharging"})
      actions.push_back(offered(type, {"INSTANT", "NODE"}));
  for (const std::string& type : facts.node_actions) actions.push_back(offered(type.c_str(), {"NODE"}));
  return actions;
}

OrderedJson limits_kept() {
  const MessageLimits limits;
  return {
      {"maxStringLens", {{"msgLen", limits.bytes}, {"idLen", limits.text_bytes}, {"idNumericalOnly", false}}},
      {"maxArrayLens",
       {{"order.nodes", limits.nodes},
        {"order.edges", limits.nodes},
        {"node.actions", limits.actions},
        {"edge.actions", 0},
        {"actions.actionsParameters", limits.parameters},
        {"instantActions", limits.actions}}},
      {"timing", {{"minOrderInterval", 0.1}, {"minStateInterval", 0.1}, {"defaultStateInterval", 30.0}}}};
}

/// A disc as twelve corners about it.
std::vector<Vec2> around_disc(double radius_m) {
  constexpr int corners = 12;
  constexpr double step_rad = 2.0 * std::numbers::pi / corners;
  std::vector<Vec2> outline_m;
  for (int i = 0; i < corners; ++i)
    outline_m.emplace_back(radius_m / std::cos(step_rad / 2.0) *
                           Vec2(std::cos(i * step_rad), std::sin(i * step_rad)));
  return outline_m;
}

}  // namespace

std::string timestamp_text(std::int64_t unix_ms) {
  const std::chrono::sys_time<std::chrono::milliseconds> time{std::chrono::milliseconds(unix_ms)};
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", whole, (time - whole).count());
}

std::string state_text(const MessageHeader& header, const FleetReport& report) {
  OrderedJson json = opened(header);
  json["orderId"] = report.order_id;
  json["orderUpdateId"] = report.update_id;
  json["lastNodeId"] = report.last_node_id;
  json["lastNodeSequenceId"] = report.last_sequence;
  json["driving"] = report.driving;
  json["paused"] = report.paused;
  json["newBaseRequest"] = report.wants_base;
  json["distanceSinceLastNode"] = report.since_last_node_m;
  json["operatingMode"] = to_string(report.mode);
  json["nodeStates"] =
      array_of(report.nodes, [&](const FleetNode& node) { return node_state(node, header.version); });
  json["edgeStates"] = array_of(report.edges, [](const FleetEdge& edge) -> OrderedJson {
    return {{"edgeId", edge.id}, {"sequenceId", edge.sequence}, {"released", edge.released}};
  });
  if (report.map_from_base) json["agvPosition"] = position_state(report);
  json["velocity"] = {
      {"vx", report.velocity.forward_mps}, {"vy", 0.0}, {"omega", report.velocity.turn_radps}};
  json["actionStates"] = array_of(report.actions, action_state);
  json["batteryState"] = {{"batteryCharge", report.charge_percent}, {"charging", report.charging}};
  if (report.battery_v) json["batteryState"]["batteryVoltage"] = *report.battery_v;
  json["errors"] = array_of(report.errors, error_state);
  json["safetyState"] = {{"eStop", to_string(report.emergency_stop)},
                         {"fieldViolation", report.field_violation}};
  return text_of(json);
}

std::string connection_text(const MessageHeader& header, ConnectionState state) {
  OrderedJson json = opened(header);
  json["connectionState"] = to_string(state);
  return text_of(json);
}

Factsheet factsheet_of(const Robot& robot, const FleetSettings& settings, bool charges) {
  Factsheet facts{.series = robot.name,
                  .slowest_mps = robot.dead_band_mps.value_or(0.0),
                  .fastest_mps = robot.max_forward_mps,
                  .acceleration_mps2 = robot.max_acceleration_mps2,
                  .height_m = robot.base_from_camera.translation().z(),
                  .width_m = 2.0 * robot.radius_m,
                  .length_m = 2.0 * robot.radius_m,
                  .radius_m = robot.radius_m,
                  .outline_m = {},
                  .charges = charges,
                  .node_actions = {}};
  for (const ActionHook& hook : settings.actions) facts.node_actions.push_back(hook.type);
  if (!robot.footprint) return facts;
  const auto& corners_m = robot.footprint->corners_m();
  facts.outline_m.assign(corners_m.begin(), corners_m.end());
  Vec2 low = facts.outline_m.front();
  Vec2 high = low;
  for (const Vec2& corner : facts.outline_m) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  facts.length_m = high.x() - low.x();
  facts.width_m = high.y() - low.y();
  return facts;
}

/// The largest load is not known here: it is said to be none. Optional fields of edges and orders that the
/// robot obeys are listed; one that is not leads to an orderError.
std::string factsheet_text(const MessageHeader& header, const Factsheet& facts) {
  OrderedJson json = opened(header);
  json["typeSpecification"] = {{"seriesName", facts.series},    {"agvKinematic", "DIFF"},
                               {"agvClass", "CARRIER"},         {"maxLoadMass", 0.0},
                               {"localizationTypes", {"SPOT"}}, {"navigationTypes", {"AUTONOMOUS"}}};
  json["physicalParameters"] = {{"speedMin", facts.slowest_mps},
                                {"speedMax", facts.fastest_mps},
                                {"accelerationMax", facts.acceleration_mps2},
                                {"decelerationMax", facts.acceleration_mps2},
                                {"heightMax", facts.height_m},
                                {"width", facts.width_m},
                                {"length", facts.length_m}};
  json["protocolLimits"] = limits_kept();
  OrderedJson obeyed = OrderedJson::array();
  for (const char* name : {"order.nodes.nodePosition.theta", "order.nodes.nodePosition.allowedDeviationXY",
                           "order.nodes.nodePosition.allowedDeviationTheta", "order.edges.maxSpeed"})
    obeyed.push_back({{"parameter", name}, {"support", "SUPPORTED"}});
  json["protocolFeatures"] = {{"optionalParameters", std::move(obeyed)},
                              {"agvActions", actions_offered(facts)}};
  const std::vector<Vec2> outline_m = facts.outline_m.empty() ? around_disc(facts.radius_m) : facts.outline_m;
  json["agvGeometry"] = {
      {"envelopes2d",
       OrderedJson::array(
           {{{"set", "body"}, {"polygonPoints", array_of(outline_m, [](const Vec2& p) -> OrderedJson {
                                 return {{"x", p.x()}, {"y", p.y()}};
                               })}}})}};
  json["loadSpecification"] = OrderedJson::object();
  return text_of(json);
}

}  // namespace lodestar
