#pragma once

#include <fmt/format.h>

#include "app/fleet/order_book.hpp"

namespace lodestar {

inline OrderBookOptions lab_options() {
  return {.map = "lab",
          .positions = {{"dock", {.position_m = {1.0, 1.0}, .heading_rad = {}, .map = "lab"}}},
          .node_actions = {"wait"},
          .instant_actions = {"initPosition", "stateRequest", "factsheetRequest"},
          .slowest_mps = 0.05};
}

inline FleetAction action(const std::string& id, const std::string& type = "wait",
                          Blocking blocking = Blocking::hard) {
  return {.id = id, .type = type, .blocking = blocking, .parameters = {}};
}

/// Nodes n0, n1, ... at x = 0, 1, ... metres: from `first`, `count` of them, the first `released` are the
/// base.
inline FleetOrder order_over(const std::string& id, std::uint32_t update, std::uint32_t first,
                             std::uint32_t count, std::uint32_t released) {
  FleetOrder order{.id = id, .update = update, .zone_set = {}, .nodes = {}, .edges = {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t number = first + i;
    FleetNode node{.id = fmt::format("n{}", number), .sequence = 2 * number, .released = i < released};
    node.at = NodePosition{.position_m = {number, 0.0}, .heading_rad = {}, .map = "lab"};
    order.nodes.push_back(node);
    if (i == 0) continue;
    order.edges.push_back({.id = fmt::format("e{}", number - 1),
                           .sequence = 2 * number - 1,
                           .released = i < released,
                           .from = fmt::format("n{}", number - 1),
                           .to = node.id,
                           .max_mps = {},
                           .actions = {},
                           .demands = {}});
  }
  return order;
}

inline const Pose2 at_start{{0.0, 0.0}, 0.0};

/// "n1 n2 (n3)": the nodes that are left, those of the horizon in brackets.
inline std::string left_of(const OrderBook& book) {
  std::string words;
  for (const FleetNode& node : book.nodes())
    words += fmt::format("{}{}", words.empty() ? "" : " ", node.released ? node.id : "(" + node.id + ")");
  return words;
}

/// Of an action; an unknown one waits.
inline ActionStatus status_of(const OrderBook& book, const std::string& id) {
  for (const ActionRecord& record : book.actions())
    if (record.action.id == id) return record.status;
  return ActionStatus::waiting;
}

inline std::string first_error(const OrderBook& book) {
  const std::vector<FleetError> errors = book.errors();
  return errors.empty() ? "" : errors.front().type;
}

}  // namespace lodestar
