#include "app/fleet/message_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/fleet/message_writer.hpp"

// Lenient with what masters are known to send, and never in doubt about what is no order.
namespace lodestar {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

nlohmann::json an_order() {
  return nlohmann::json::parse(
      R"({"headerId": 7, "timestamp": "whenever", "version": "2.0.0", "manufacturer": "",
    "serialNumber": "", "orderId": "a", "orderUpdateId": 2,
    "nodes": [{"nodeId": "n0", "sequenceId": 0, "released": true, "actions": [],
               "nodePosition": {"x": 1, "y": 2.5, "theta": 0.5, "mapId": "", "allowedDeviationXy": 0.4}},
              {"nodeId": "n1", "sequenceId": 2.0, "released": false, "actions": [
                {"actionId": "w", "actionName": "wait", "blockingType": "SOFT",
                 "actionParameters": [{"key": "seconds", "value": "2.5"}, {"key": "list", "value": [1, true]}]}]}],
    "edges": [{"edgeId": "e", "sequenceId": 1, "released": false, "startNodeId": "n0", "endNodeId": "n1",
               "actions": [], "maxSpeed": 0.4, "orientation": 0, "maxHeight": 0}]})");
}

FleetError error_of(const FleetMessage& message) {
  const auto* error = std::get_if<FleetError>(&message);
  return error == nullptr ? FleetError{.type = "none", .description = {}, .references = {}} : *error;
}

TEST(MessageReader, reads_an_order_in_the_spellings_that_masters_use) {
  const FleetMessage message = read_order(an_order().dump(), {"ACME", "one"});
  ASSERT_TRUE(std::holds_alternative<FleetOrder>(message)) << error_of(message).description;
  const FleetOrder& order = std::get<FleetOrder>(message);
  EXPECT_EQ(order.header, 7U);
  EXPECT_EQ(order.update, 2U);
  ASSERT_EQ(order.nodes.size(), 2U);
  EXPECT_EQ(order.nodes[0].at->position_m, Vec2(1.0, 2.5));
  EXPECT_EQ(order.nodes[0].at->deviation_m, 0.4);
  EXPECT_EQ(order.nodes[1].sequence, 2U);
  const FleetAction& action = order.nodes[1].actions.at(0);
  EXPECT_EQ(action.type, "wait");
  EXPECT_EQ(action.blocking, Blocking::soft);
  EXPECT_EQ(number_in(action, "seconds"), 2.5);
  EXPECT_EQ(number_in(action, "list"), std::nullopt);
  EXPECT_EQ(order.edges[0].max_mps, 0.4);
  EXPECT_TRUE(order.edges[0].demands.empty());
}

TEST(MessageReader, reads_instant_actions_under_both_names) {
  for (const char* key : {"actions", "instantActions"}) {
    nlohmann::json json;
    json[key] =
        nlohmann::json::parse(R"([{"actionId": "p", "actionType": "startPause", "blockingType": "HARD"}])");
    const FleetMessage message = read_instant_actions(json.dump());
    ASSERT_TRUE(std::holds_alternative<InstantActions>(message)) << key;
    EXPECT_EQ(std::get<InstantActions>(message).actions.at(0).type, "startPause");
  }
}

TEST(MessageReader, names_the_demands_of_an_edge) {
  for (const auto& [key, value] : std::vector<std::pair<std::string, nlohmann::json>>{
           {"corridor", {{"leftWidth", 1}, {"rightWidth", 1}}},
           {"trajectory", nlohmann::json::object()},
           {"rotationAllowed", false},
           {"maxRotationSpeed", 0.5},
           {"orientation", 1.57}}) {
    nlohmann::json json = an_order();
    json["edges"][0][key] = value;
    const FleetMessage message = read_order(json.dump());
    ASSERT_TRUE(std::holds_alternative<FleetOrder>(message)) << key;
    EXPECT_THAT(std::get<FleetOrder>(message).edges[0].demands, Contains(key));
  }
}

/// Each change makes one of the sound order.
TEST(MessageReader, refers_to_what_is_wrong) {
  struct Case {
    std::function<void(nlohmann::json&)> spoil;
    ErrorReference reference;
  };
  const std::vector<Case> cases{
      {[](auto& json) { json.erase("orderUpdateId"); }, {"orderId", "a"}},
      {[](auto& json) { json["nodes"][1].erase("released"); }, {"nodeId", "n1"}},
      {[](auto& json) { json["nodes"][0]["nodePosition"]["x"] = "far"; }, {"nodeId", "n0"}},
      {[](auto& json) { json["nodes"][0]["nodePosition"]["x"] = 1e300; }, {"nodeId", "n0"}},
      {[](auto& json) { json["nodes"][1]["actions"][0]["blockingType"] = "MAYBE"; }, {"actionId", "w"}},
      {[](auto& json) { json["nodes"][1]["sequenceId"] = 4; }, {"orderUpdateId", "2"}},
      {[](auto& json) { json["nodes"][1]["sequenceId"] = -2; }, {"nodeId", "n1"}},
      {[](auto& json) { json["edges"][0]["endNodeId"] = "n7"; }, {"orderId", "a"}},
      {[](auto& json) { json["edges"] = nlohmann::json::array(); }, {"orderId", "a"}},
      {[](auto& json) { json["nodes"][0]["released"] = false; }, {"orderId", "a"}},
      {[](auto& json) { json["nodes"][1]["actions"].push_back(json["nodes"][1]["actions"][0]); },
       {"actionId", "w"}},
      {[](auto& json) { json["serialNumber"] = "another"; }, {"headerId", "7"}},
      {[](auto& json) { json["version"] = "3.0.0"; }, {"headerId", "7"}},
      {[](auto& json) { json["nodes"] = 3; }, {"orderId", "a"}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    nlohmann::json json = an_order();
    cases[i].spoil(json);
    const FleetError error = error_of(read_order(json.dump(), {"ACME", "one"}));
    EXPECT_EQ(error.type, vda_error::validation) << "case " << i;
    EXPECT_THAT(error.references, Contains(cases[i].reference)) << "case " << i << ": " << error.description;
    EXPECT_THAT(error.references, Contains(ErrorReference{"topic", "order"})) << "case " << i;
  }
}

TEST(MessageReader, refuses_what_is_too_large_too_deep_or_no_text) {
  EXPECT_THAT(error_of(read_order(std::string(1U << 20U, '['))).description, HasSubstr("bytes"));
  EXPECT_THAT(error_of(read_order(std::string(100'000, '['))).description, HasSubstr("nested"));
  for (const std::string text : {"", "null", "[]", "{\"\xff\xfe\": 1}", "{\"orderId\": \"\xc3\"}"})
    EXPECT_EQ(error_of(read_order(text)).type, vda_error::validation) << text;
  nlohmann::json json = an_order();
  while (json["nodes"].size() < 2000) json["nodes"].push_back(json["nodes"][0]);
  EXPECT_THAT(error_of(read_order(json.dump())).description, HasSubstr("2000 nodes"));
  json = an_order();
  json["orderId"] = std::string(300, 'x');
  EXPECT_THAT(error_of(read_order(json.dump())).description, HasSubstr("300 bytes"));
}

TEST(MessageWriter, repeats_bytes_of_a_master_as_valid_text) {
  FleetReport report;
  report.errors.push_back({.type = "e", .description = "\xff", .references = {{"orderId", "\xc3"}}});
  const MessageHeader header{
      .timestamp = timestamp_text(1'764'041'700'123), .manufacturer = "A", .serial = "1"};
  const auto json = nlohmann::json::parse(state_text(header, report));
  EXPECT_EQ(json["timestamp"], "2025-11-25T03:35:00.123Z");
  EXPECT_EQ(json["errors"].size(), 1U);
  EXPECT_EQ(json["nodeStates"], nlohmann::json::array());
}

}  // namespace
}  // namespace lodestar
