#include "app/fleet/fleet_session.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <span>

#include "app/navigation/navigation_setup.hpp"
#include "app/recording/drive_moment.hpp"

namespace lodestar {
namespace {

Goal goal_of(const DriveTarget& target) {
  return {.position_m = target.position_m,
          .heading_rad = target.heading_rad,
          .passes = !target.rests,
          .max_mps = target.max_mps};
}

std::vector<Goal> goals_of(std::span<const DriveTarget> targets) {
  std::vector<Goal> goals;
  std::ranges::transform(targets, std::back_inserter(goals), goal_of);
  return goals;
}

}  // namespace

FleetSessionOptions fleet_session_options(const Site& site, const FleetSettings& settings) {
  constexpr double ahead_s = 3.0;
  FleetSessionOptions options;
  OrderBookOptions& book = options.book;
  book.map = settings.map.empty() ? site.name : settings.map;
  for (const Place& place : site.places.places)
    book.positions[place.name] = {
        .position_m = place.position_m, .heading_rad = place.yaw_rad, .map = book.map};
  for (const RouteNode& node : site.places.nodes)
    book.positions[node.name] = {.position_m = node.position_m, .heading_rad = {}, .map = book.map};
  book.node_actions = {"wait"};
  for (const ActionHook& hook : settings.actions) book.node_actions.insert(hook.type);
  options.hooks = settings.actions;
  options.folder = site.folder;
  book.instant_actions = {"initPosition", "stateRequest", "factsheetRequest"};
  options.charging = site.charging;
  if (options.charging) {
    options.charging->low_v.reset();  // when to charge is the master's business
    for (const char* type : {"startCharging", "stopCharging"}) {
      book.node_actions.insert(type);
      book.instant_actions.insert(type);
    }
  }
  book.slowest_mps = navigation_options(site.robot).drive.min_forward_mps;
  options.battery = load_battery_curve(site.robot_file);
  const double fastest_mps = site.robot.max_forward_mps;
  options.ask_for_base_m =
      ahead_s * fastest_mps + fastest_mps * fastest_mps / (2.0 * site.robot.max_acceleration_mps2);
  return options;
}

FleetSession::FleetSession(FleetLink& link, FleetSessionOptions options,
                           std::function<void(const std::string&)> tell)
    : link_(link),
      options_(std::move(options)),
      tell_(std::move(tell)),
      book_(options_.book),
      hooks_(options_.hooks, options_.folder) {
  if (options_.charging) charging_.emplace(*options_.charging, tell_);
}

void FleetSession::say(const std::string& words) const {
  if (tell_) tell_("fleet: " + words);
}

void FleetSession::hear(const SensorInput& input) {
  if (reported_) elapsed_ = input.now - now_;
  now_ = input.now;
  wheels_.take(input.base.travel);
  for (const WheelTravel& reading : input.base.travel) {
    if (travel_)
      driven_m_ += std::abs(reading.left_m - travel_->left_m + reading.right_m - travel_->right_m) / 2.0;
    travel_ = reading;
  }
  base_ = {.state = input.base.state,
           .fault = input.base.fault,
           .details = input.base.details,
           .travel = {},
           .measured = input.base.measured,
           .system = input.base.system};
}

void FleetSession::attend(const MissionStep& step, Mission& mission) {
  if (charging_) charging_->watch(now_, base_, step, mission);
  follow(step, mission);
  see_who_drives(mission);
  take_messages(step.navigation);
  hold(mission);
  act(mission);
  drive(mission);
  note_stop(step.navigation);
  report(step.navigation, mission);
}

/// What the drive has come to.
void FleetSession::follow(const MissionStep& step, Mission& mission) {
  if (!is_ours_) return;
  const bool has_ended_goal = step.event != MissionEvent::none && step.event != MissionEvent::path_planned;
  if (has_ended_goal && mission.current() > 0 && mission.current() <= targets_.size()) {
    const DriveTarget& target = targets_[mission.current() - 1];
    if (step.event != MissionEvent::goal_failed) {
      book_.reached(target.sequence);
      say((step.event == MissionEvent::goal_passed ? "past node " : "at node ") + target.node);
    } else if (!is_stopped_by_us_ && mission.failure() != "stopped by the operator") {
      book_.drive_failed(mission.failure());
      say(fmt::format("node {} not reached: {}", target.node, mission.failure()));
      stop(mission);
    }
  }
  if (mission.finished()) is_ours_ = false;
}

/// For the master, or because a node cannot be reached: those after it are not driven to.
void FleetSession::stop(Mission& mission) {
  mission.stop();
  is_stopped_by_us_ = true;
}

/// A person's stop of the master's drive is seen while it brakes.
void FleetSession::see_who_drives(const Mission& mission) {
  const bool is_another = !mission.finished() && !is_ours_;
  const bool is_stopped = is_ours_ && mission.phase() == MissionPhase::stopping && !is_stopped_by_us_;
  const bool is_manual = is_another || is_stopped || mission.phase() == MissionPhase::by_hand;
  if (is_manual && book_.mode() == OperatingMode::automatic && book_.is_active())
    say("a person took over: the order is cleared");
  book_.set_mode(is_manual ? OperatingMode::manual : OperatingMode::automatic);
}

void FleetSession::take_messages(const NavigationStep& step) {
  std::optional<Pose2> map_from_base;
  if (step.estimate) map_from_base = step.estimate->map_from_base;
  for (const FleetMessage& message : link_.take_messages()) {
    const std::uint64_t before = book_.revision();
    book_.take(message, map_from_base);
    if (book_.revision() == before) continue;
    if (const auto* order = std::get_if<FleetOrder>(&message)) {
      const bool is_taken = book_.order_id() == order->id && book_.update_id() == order->update;
      say(fmt::format("order {} ({}) {}", order->id, order->update,
                      is_taken ? "accepted" : "rejected: " + book_.errors().back().description));
    } else if (const auto* actions = std::get_if<InstantActions>(&message)) {
      for (const FleetAction& action : actions->actions) say("asked for " + action.type);
    } else {
      say("a message cannot be read: " + std::get<FleetError>(message).description);
    }
  }
}

/// Pause and cancellation. A person who lets a paused drive go on has the last word.
void FleetSession::hold(Mission& mission) {
  const bool is_under_way = is_ours_ && !mission.finished();
  if (!is_under_way) has_paused_ = false;
  if (is_under_way && has_paused_ && !mission.paused()) book_.resume();
  if (is_under_way && book_.is_paused() && !mission.paused()) mission.pause();
  if (is_under_way && has_paused_ && !book_.is_paused()) mission.resume();
  has_paused_ = is_under_way && book_.is_paused();
  if (is_under_way && book_.is_cancelling() && !is_stopped_by_us_) stop(mission);
  const bool may_rest = mission.finished() || (mission.paused() && !book_.is_cancelling());
  if (may_rest && wheels_.holds()) book_.came_to_rest();
}

void FleetSession::act(Mission& mission) {
  go_on_waiting();
  go_on_charging();
  hooks_.keep([this](const std::string& id) { return book_.is_running(id); });
  for (const HookResult& result : hooks_.take_ended()) {
    if (!result.succeeded) say(fmt::format("action {}: {}", result.action_id, result.words));
    book_.action_ended(result.action_id, result.succeeded, result.words);
  }
  for (const FleetAction& action : book_.start_actions()) begin(action, mission);
}

void FleetSession::begin(const FleetAction& action, Mission& mission) {
  constexpr double longest_wait_s = 86400.0;
  if (action.type == "initPosition") {
    place(action, mission);
  } else if (action.type == "stateRequest") {
    is_state_asked_ = true;
    book_.action_ended(action.id, true);
  } else if (action.type == "factsheetRequest") {
    link_.ask_for_factsheet();
    book_.action_ended(action.id, true);
  } else if (action.type == "startCharging" && charging_) {
    charge(action, mission);
  } else if (action.type == "stopCharging" && charging_) {
    charging_->end();  // nothing on board switches the current: it ends as the robot leaves
    book_.action_ended(action.id, true);
  } else if (hooks_.carries_out(action.type)) {
    hooks_.start(action);
  } else {
    const std::optional<double> wait_s = number_in(action, "seconds");
    if (!wait_s || *wait_s < 0.0 || *wait_s > longest_wait_s) {
      book_.action_ended(action.id, false, "seconds is no number from 0 to 86400");
    } else {
      waits_.push_back({action.id, from_seconds(*wait_s)});
    }
  }
}

void FleetSession::place(const FleetAction& action, Mission& mission) {
  const auto x_m = number_in(action, "x");
  const auto y_m = number_in(action, "y");
  const auto yaw_rad = number_in(action, "theta");
  const auto map = action.parameters.find("mapId");
  const auto fail = [&](const std::string& why) { book_.action_ended(action.id, false, why); };
  if (!x_m || !y_m || !yaw_rad || std::abs(*x_m) > far_m || std::abs(*y_m) > far_m)
    return fail("x, y and theta are wanted");
  if (map != action.parameters.end() && !map->second.empty() && map->second != options_.book.map)
    return fail(fmt::format("map {}, the robot has {}", map->second, options_.book.map));
  if (!mission.finished() || book_.is_active()) return fail("an order is under way");
  if (!mission.place_robot({{*x_m, *y_m}, wrap_angle(*yaw_rad)})) return fail("no wheel reading yet");
  const auto node = action.parameters.find("lastNodeId");
  if (node != action.parameters.end()) book_.set_last_node(node->second);
  book_.action_ended(action.id, true);
}

/// From wherever it stands onto the dock; done when the battery charges.
void FleetSession::charge(const FleetAction& action, Mission& mission) {
  const auto fail = [&](const std::string& why) { book_.action_ended(action.id, false, why); };
  if (charge_action_) return fail("another action brings the robot to the dock");
  if (!mission.finished() || !book_.targets().empty()) return fail("the robot has somewhere to drive");
  charge_action_ = action.id;
  if (charging_->state() != ChargingState::none) return;  // it is there
  charging_->begin(mission);
  targets_.clear();  // no node of the order
  is_ours_ = true;
  is_stopped_by_us_ = false;
}

void FleetSession::go_on_charging() {
  if (!charge_action_) return;
  const ChargingState state = charging_->state();
  const bool is_charged = state == ChargingState::charging || state == ChargingState::full;
  if (book_.is_running(*charge_action_)) {
    if (charging_->is_under_way() && !is_charged) return;
    const std::string& why = charging_->failure();
    book_.action_ended(*charge_action_, is_charged, is_charged || !why.empty() ? why : "off the dock");
  }
  charge_action_.reset();
}

void FleetSession::go_on_waiting() {
  std::erase_if(waits_, [&](Wait& wait) {
    if (!book_.is_running(wait.action)) return true;
    if (book_.is_paused()) return false;
    wait.left -= elapsed_;
    if (wait.left > Duration::zero()) return false;
    book_.action_ended(wait.action, true);
    return true;
  });
}

/// Over the released nodes in one flow; what is released meanwhile is appended to it.
void FleetSession::drive(Mission& mission) {
  if (book_.mode() == OperatingMode::manual) return;
  const std::vector<DriveTarget> targets = book_.targets();
  if (targets.empty()) return;
  if (mission.finished()) {
    if (mission.phase() != MissionPhase::idle) return;
    targets_ = targets;
    mission.start(goals_of(targets_));
    is_ours_ = true;
    is_stopped_by_us_ = false;
  } else if (is_ours_ && !is_stopped_by_us_ && !targets_.empty()) {
    const auto is_new = [&](const DriveTarget& target) { return target.sequence > targets_.back().sequence; };
    const auto more = std::ranges::find_if(targets, is_new);
    if (more == targets.end()) return;
    mission.pass_last();  // it was the last because no more was released
    mission.append(goals_of({more, targets.end()}));
    targets_.insert(targets_.end(), more, targets.end());
  }
}

}  // namespace lodestar
