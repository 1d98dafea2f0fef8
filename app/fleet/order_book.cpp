#include "app/fleet/order_book.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace lodestar {
namespace {

/// References to an order, as masters look for them.
FleetError order_error(const char* type, const FleetOrder& order, std::string words,
                       std::vector<ErrorReference> more = {}) {
  FleetError error{.type = type,
                   .description = std::move(words),
                   .references = {{"topic", "order"},
                                  {"headerId", std::to_string(order.header)},
                                  {"orderId", order.id},
                                  {"orderUpdateId", std::to_string(order.update)}}};
  std::ranges::move(more, std::back_inserter(error.references));
  return error;
}

/// But for the message that caused them.
bool is_same(const FleetError& a, const FleetError& b) {
  const auto without_header = [](std::vector<ErrorReference> references) {
    std::erase_if(references, [](const ErrorReference& one) { return one.key == "headerId"; });
    return references;
  };
  return a.type == b.type && a.description == b.description &&
         without_header(a.references) == without_header(b.references);
}

}  // namespace

OrderBook::OrderBook(OrderBookOptions options) : options_(std::move(options)) {}

void OrderBook::take(const FleetMessage& message, const std::optional<Pose2>& map_from_base) {
  if (const auto* order = std::get_if<FleetOrder>(&message)) {
    take_order(*order, map_from_base);
  } else if (const auto* actions = std::get_if<InstantActions>(&message)) {
    for (const FleetAction& action : actions->actions) take_instant(action);
  } else {
    reject(std::get<FleetError>(message));
  }
}

/// Figure 8. Whether the message is sound was decided where it was read.
void OrderBook::take_order(const FleetOrder& order, const std::optional<Pose2>& map_from_base) {
  const bool is_update = order.id == order_id_;
  if (is_update && order.update == update_id_) return;  // sent again
  if (mode_ == OperatingMode::manual)
    return reject(order_error(vda_error::order, order, "a person drives the robot",
                              {{"operatingMode", std::string(to_string(mode_))}}));
  if (is_cancelling_)
    return reject(order_error(vda_error::order, order, "the present order is being cancelled"));
  if (!is_update && is_active())
    return reject(order_error(vda_error::order, order, fmt::format("order {} is not done", order_id_)));
  if (is_update && order.update < update_id_)
    return reject(
        order_error(vda_error::order_update, order, fmt::format("orderUpdateId {} came before", update_id_)));
  if (is_update && was_cleared_)
    return reject(order_error(vda_error::order_update, order, "this order was cancelled"));
  if (std::optional<FleetError> error = infeasible(order)) return reject(std::move(*error));
  if (is_update) {
    update(order);
  } else {
    begin(order, map_from_base);
  }
}

std::optional<FleetError> OrderBook::infeasible(const FleetOrder& order) const {
  const auto refuse = [&](std::string words, std::vector<ErrorReference> more) {
    return order_error(vda_error::order, order, std::move(words), std::move(more));
  };
  if (!order.zone_set.empty()) return refuse("zoneSetId is not supported", {{"zoneSetId", order.zone_set}});
  for (const FleetNode& node : order.nodes) {
    const NodePosition* at = position_of(node);
    if (at == nullptr) return refuse("no nodePosition, and no place of that name", {{"nodeId", node.id}});
    if (!at->map.empty() && at->map != options_.map)
      return refuse(fmt::format("map {}, the robot has {}", at->map, options_.map), {{"nodeId", node.id}});
    for (const FleetAction& action : node.actions)
      if (!options_.node_actions.contains(action.type))
        return refuse(fmt::format("no action {} at nodes", action.type),
                      {{"nodeId", node.id}, {"actionId", action.id}, {"actionType", action.type}});
  }
  for (const FleetEdge& edge : order.edges) {
    if (!edge.demands.empty())
      return refuse(fmt::format("{} is not supported", edge.demands.front()),
                    {{"edgeId", edge.id}, {"parameter", edge.demands.front()}});
    if (edge.max_mps && *edge.max_mps < options_.slowest_mps)
      return refuse(fmt::format("maxSpeed {} is below {} m/s, the least at which the robot moves",
                                *edge.max_mps, options_.slowest_mps),
                    {{"edgeId", edge.id}, {"parameter", "maxSpeed"}});
    if (!edge.actions.empty())
      return refuse("no actions on edges", {{"edgeId", edge.id}, {"actionId", edge.actions.front().id}});
  }
  return std::nullopt;
}

void OrderBook::begin(const FleetOrder& order, const std::optional<Pose2>& map_from_base) {
  const FleetNode& first = order.nodes.front();
  const auto no_route = [&](const std::string& words) {
    reject(order_error(vda_error::no_route, order, words, {{"nodeId", first.id}}));
  };
  if (!map_from_base) return no_route("the robot does not know where it is");
  const NodePosition& at = *position_of(first);
  const double distance_m = (map_from_base->position_m - at.position_m).norm();
  const double allowed_m = at.deviation_m > 0.0 ? at.deviation_m : options_.start_tolerance_m;
  if (distance_m > allowed_m)
    return no_route(fmt::format("the robot is {:.2f} m from the first node, {:.2f} m are allowed", distance_m,
                                allowed_m));
  drop_rejections();
  drive_error_.reset();
  was_cleared_ = false;
  order_id_ = order.id;
  update_id_ = order.update;
  nodes_.clear();
  edges_.clear();
  order_actions_.clear();
  std::erase_if(instant_actions_, [&](const ActionRecord& record) {
    if (has_ended(record)) old_action_ids_.push_back(record.action.id);
    return has_ended(record);
  });
  constexpr std::size_t most_remembered = 1000;
  while (old_action_ids_.size() > most_remembered) old_action_ids_.pop_front();
  append(order, 0);
  const double turn_rad =
      at.heading_rad ? std::abs(wrap_angle(map_from_base->yaw_rad - *at.heading_rad)) : 0.0;
  const double within_rad = at.deviation_rad > 0.0 ? at.deviation_rad : options_.heading_tolerance_rad;
  if (turn_rad <= within_rad) reached(first.sequence);
  changed();
}

void OrderBook::update(const FleetOrder& order) {
  const auto last = std::ranges::find(nodes_, false, &FleetNode::released);
  const bool is_at_end = last == nodes_.begin();  // no released node is ahead
  const std::string& end_id = is_at_end ? last_node_id_ : std::prev(last)->id;
  const std::uint32_t end_sequence = is_at_end ? last_sequence_ : std::prev(last)->sequence;
  const FleetNode& first = order.nodes.front();
  if (first.id != end_id || first.sequence != end_sequence)
    return reject(order_error(vda_error::order_update, order,
                              fmt::format("begins with node {} ({}), the last released one is {} ({})",
                                          first.id, first.sequence, end_id, end_sequence),
                              {{"nodeId", first.id}}));
  for (const FleetNode& node : order.nodes) {
    const bool is_stitch = &node == &first;
    for (const FleetAction& action : node.actions) {
      const bool is_repeated = std::ranges::any_of(order_actions_, [&](const ActionRecord& record) {
        const bool is_of_horizon = record.sequence > end_sequence;
        return record.action.id == action.id && !is_of_horizon &&
               !(is_stitch && record.sequence == end_sequence);
      });
      if (is_repeated)
        return reject(order_error(vda_error::order_update, order, "an actionId of the base is used again",
                                  {{"nodeId", node.id}, {"actionId", action.id}}));
    }
  }
  drop_rejections();
  drive_error_.reset();
  update_id_ = order.update;
  std::erase_if(nodes_, [](const FleetNode& node) { return !node.released; });
  std::erase_if(edges_, [](const FleetEdge& edge) { return !edge.released; });
  std::erase_if(order_actions_, [&](const ActionRecord& record) { return record.sequence > end_sequence; });
  FleetNode stitch = first;
  std::erase_if(stitch.actions, [&](const FleetAction& action) { return is_known(action.id); });
  add_actions(stitch, is_at_end);
  append(order, 1);
  changed();
}

void OrderBook::append(const FleetOrder& order, std::size_t from) {
  for (std::size_t i = from; i < order.nodes.size(); ++i) {
    nodes_.push_back(order.nodes[i]);
    nodes_.back().at = *position_of(order.nodes[i]);
    add_actions(order.nodes[i], false);
  }
  for (const FleetEdge& edge : order.edges) edges_.push_back(edge);
}

void OrderBook::add_actions(const FleetNode& node, bool is_due) {
  for (const FleetAction& action : node.actions)
    order_actions_.push_back({.action = action, .sequence = node.sequence, .is_due = is_due});
}

const NodePosition* OrderBook::position_of(const FleetNode& node) const {
  if (node.at) return &*node.at;
  const auto found = options_.positions.find(node.id);
  return found == options_.positions.end() ? nullptr : &found->second;
}

void OrderBook::reached(std::uint32_t sequence) {
  while (!nodes_.empty() && nodes_.front().released && nodes_.front().sequence <= sequence) {
    last_node_id_ = nodes_.front().id;
    last_sequence_ = nodes_.front().sequence;
    nodes_.pop_front();
    while (!edges_.empty() && edges_.front().sequence < last_sequence_) edges_.pop_front();
    for (ActionRecord& record : order_actions_)
      if (record.sequence == last_sequence_) record.is_due = true;
    changed();
  }
}

void OrderBook::drive_failed(const std::string& why) {
  drive_error_ = FleetError{.type = vda_error::drive,
                            .level = ErrorLevel::fatal,
                            .description = why,
                            .references = {{"orderId", order_id_},
                                           {"orderUpdateId", std::to_string(update_id_)},
                                           {"nodeId", nodes_.empty() ? last_node_id_ : nodes_.front().id}}};
  changed();
}

void OrderBook::set_mode(OperatingMode mode) {
  if (mode == mode_) return;
  mode_ = mode;
  changed();
  if (mode == OperatingMode::manual) clear_order("a person took over");
}

/// The ID stays, so that no update of this order is taken for a new one.
void OrderBook::clear_order(const std::string& why) {
  was_cleared_ = was_cleared_ || is_active();
  nodes_.clear();
  edges_.clear();
  drive_error_.reset();
  for (ActionRecord& record : order_actions_) {
    if (has_ended(record)) continue;
    record.status = ActionStatus::failed;
    record.result = why;
  }
  is_cancelling_ = false;
  for (ActionRecord& record : instant_actions_)
    if (record.action.type == "cancelOrder" && !has_ended(record)) record.status = ActionStatus::finished;
  changed();
}

void OrderBook::resume() {
  if (std::exchange(is_paused_, false)) changed();
}

void OrderBook::set_last_node(const std::string& id) {
  last_node_id_ = id;
  changed();
}

void OrderBook::set_stopped(const std::string& why) {
  if (why == stopped_) return;
  stopped_ = why;
  changed();
}

bool OrderBook::is_active() const {
  return !nodes_.empty() || !std::ranges::all_of(order_actions_, has_ended);
}

void OrderBook::reject(FleetError error) {
  constexpr std::size_t most_kept = 20;
  if (std::ranges::any_of(rejections_, [&](const FleetError& known) { return is_same(known, error); }))
    return;
  rejections_.push_back(std::move(error));
  if (rejections_.size() > most_kept) rejections_.pop_front();
  changed();
}

void OrderBook::drop_rejections() {
  rejections_.clear();
}

std::vector<FleetError> OrderBook::errors() const {
  std::vector<FleetError> errors(rejections_.begin(), rejections_.end());
  if (drive_error_) errors.push_back(*drive_error_);
  if (!stopped_.empty())
    errors.push_back({.type = vda_error::stopped, .description = stopped_, .references = {}});
  return errors;
}

}  // namespace lodestar
