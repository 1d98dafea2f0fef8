#include <algorithm>
#include <fmt/format.h>
#include <functional>

#include "app/fleet/order_book.hpp"

// Of the order book: actions, pause and cancellation.
namespace lodestar {
/// An actionId that was seen before is the same action, sent again.
void OrderBook::take_instant(const FleetAction& action) {
  if (is_known(action.id)) return;
  constexpr std::size_t most_listed = 50;
  constexpr std::ptrdiff_t most_open = 20;
  const bool are_too_many = std::ranges::count_if(instant_actions_, std::not_fn(has_ended)) >= most_open;
  const auto ended = std::ranges::find_if(instant_actions_, has_ended);
  if (instant_actions_.size() >= most_listed && ended != instant_actions_.end()) {
    old_action_ids_.push_back(ended->action.id);
    instant_actions_.erase(ended);
  }
  ActionRecord& record = instant_actions_.emplace_back(ActionRecord{.action = action, .is_instant = true});
  changed();
  if (action.type == "cancelOrder") return cancel(record);
  if (action.type == "startPause") {
    is_paused_ = true;
    record.status = ActionStatus::running;
  } else if (action.type == "stopPause") {
    is_paused_ = false;
    record.status = ActionStatus::finished;
    for (ActionRecord& other : instant_actions_)
      if (other.action.type == "startPause" && !has_ended(other)) other.status = ActionStatus::finished;
  } else if (are_too_many) {
    action_ended(action.id, false, "too many actions at once");
  } else if (!options_.instant_actions.contains(action.type)) {
    action_ended(action.id, false, fmt::format("no instant action {}", action.type));
  }
}

void OrderBook::cancel(ActionRecord& record) {
  const auto refuse = [&](const std::string& words) {
    record.status = ActionStatus::failed;
    record.result = words;
    reject({.type = vda_error::no_order_to_cancel,
            .description = words,
            .references = {{"topic", "instantActions"},
                           {"actionId", record.action.id},
                           {"actionType", record.action.type}}});
  };
  if (!is_active()) return refuse("no order to cancel");
  if (is_cancelling_) return refuse("the order is being cancelled");
  is_cancelling_ = true;
  record.status = ActionStatus::running;
  for (ActionRecord& open : order_actions_) {
    if (has_ended(open)) continue;
    open.status = ActionStatus::failed;
    open.result = "cancelled";
  }
}

void OrderBook::came_to_rest() {
  if (is_cancelling_) clear_order("cancelled");
  for (ActionRecord& record : instant_actions_) {
    if (record.action.type != "startPause" || has_ended(record)) continue;
    record.status = ActionStatus::finished;
    changed();
  }
}

void OrderBook::action_ended(const std::string& id, bool succeeded, const std::string& result) {
  const auto end = [&](ActionRecord& record) {
    record.status = succeeded ? ActionStatus::finished : ActionStatus::failed;
    record.result = result;
    changed();
    if (succeeded) return;
    const char* type = record.is_instant ? vda_error::instant_action : vda_error::order_action;
    reject({.type = type,
            .description = result,
            .references = {{"topic", record.is_instant ? "instantActions" : "order"},
                           {"actionId", id},
                           {"actionType", record.action.type}}});
  };
  for (std::deque<ActionRecord>* list : {&order_actions_, &instant_actions_})
    for (ActionRecord& record : *list)
      if (record.action.id == id && !has_ended(record)) return end(record);
}

/// A HARD action has the robot to itself; the others go on side by side, in the order given.
std::vector<FleetAction> OrderBook::start_actions() {
  std::vector<FleetAction> begun;
  const auto begin = [&](ActionRecord& record) {
    if (record.status != ActionStatus::waiting) return;
    record.status = ActionStatus::running;
    begun.push_back(record.action);
    changed();
  };
  for (ActionRecord& record : instant_actions_) begin(record);
  if (is_paused_ || is_cancelling_) return begun;
  bool is_alone = true;
  for (ActionRecord& record : order_actions_) {
    if (!record.is_due || has_ended(record)) continue;
    const bool is_hard = record.action.blocking == Blocking::hard;
    if (!is_hard || is_alone) begin(record);
    if (is_hard) break;
    is_alone = false;
  }
  return begun;
}

bool OrderBook::must_stay() const {
  return std::ranges::any_of(order_actions_, [](const ActionRecord& record) {
    return record.is_due && !has_ended(record) && record.action.blocking != Blocking::none;
  });
}

/// A later update of the order may bring actions to a node, but not once the robot has begun to pass it.
bool OrderBook::rests_at(const FleetNode& node) const {
  return node.at->heading_rad || std::ranges::any_of(order_actions_, [&](const ActionRecord& record) {
           return record.sequence == node.sequence && record.action.blocking != Blocking::none;
         });
}

std::optional<double> OrderBook::limit_before(const FleetNode& node) const {
  const auto edge = std::ranges::find(edges_, node.sequence - 1, &FleetEdge::sequence);
  return edge == edges_.end() ? std::nullopt : edge->max_mps;
}

std::vector<DriveTarget> OrderBook::targets() const {
  std::vector<DriveTarget> targets;
  if (is_paused_ || is_cancelling_ || drive_error_ || must_stay()) return targets;
  for (const FleetNode& node : nodes_) {
    if (!node.released) break;
    DriveTarget target{.node = node.id,
                       .sequence = node.sequence,
                       .position_m = node.at->position_m,
                       .heading_rad = node.at->heading_rad,
                       .max_mps = limit_before(node),
                       .rests = rests_at(node)};
    targets.push_back(std::move(target));
    if (targets.back().rests) return targets;
  }
  if (!targets.empty()) targets.back().rests = true;
  return targets;
}

bool OrderBook::is_known(const std::string& action_id) const {
  const auto has_it = [&](const ActionRecord& record) { return record.action.id == action_id; };
  return std::ranges::any_of(order_actions_, has_it) || std::ranges::any_of(instant_actions_, has_it) ||
         std::ranges::find(old_action_ids_, action_id) != old_action_ids_.end();
}

bool OrderBook::is_running(const std::string& action_id) const {
  return std::ranges::any_of(order_actions_, [&](const ActionRecord& record) {
    return record.action.id == action_id && record.status == ActionStatus::running;
  });
}

std::vector<ActionRecord> OrderBook::actions() const {
  std::vector<ActionRecord> all(order_actions_.begin(), order_actions_.end());
  all.insert(all.end(), instant_actions_.begin(), instant_actions_.end());
  return all;
}

}  // namespace lodestar
