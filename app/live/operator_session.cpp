#include "app/live/operator_session.hpp"

#include <fmt/format.h>

#include "app/recording/drive_moment.hpp"

namespace lodestar {
namespace {

std::string in_words(const std::vector<Goal>& goals) {
  std::string words;
  for (const Goal& goal : goals) {
    words +=
        fmt::format("{}({:.2f}, {:.2f}", words.empty() ? "" : ", ", goal.position_m.x(), goal.position_m.y());
    words += goal.heading_rad ? fmt::format(", {:.0f}°)", degrees(*goal.heading_rad)) : ")";
  }
  return words;
}

/// What keeps the robot from moving, or "ready to drive".
std::string condition_of(const SensorInput& input, const NavigationStep& step) {
  if (input.base.state != BaseState::ready) {
    return "base: " + in_words(input.base.state, input.base.fault, input.base.details);
  }
  return step.stop ? fmt::format("must not move: {}", to_string(*step.stop)) : "ready to drive";
}

/// Clients renew the order every 100 ms.
constexpr Duration steering_holds = std::chrono::milliseconds(400);

}  // namespace

OperatorSession::OperatorSession(LiveLink& link, std::function<void(const std::string&)> tell)
    : link_(link), tell_(std::move(tell)) {}

void OperatorSession::say(Stamp now, const std::string& words) {
  constexpr std::size_t most_kept = 30;
  if (tell_) tell_(words);
  events_.push_back({.number = ++said_, .stamp = now, .words = words});
  if (events_.size() > most_kept) events_.pop_front();
}

void OperatorSession::apply_orders(Mission& mission, BaseDriver& base, Stamp now, Stamp clock) {
  if (mission.finished()) {  // the next drive may be another's
    by_console_ = false;
    ticket_ = 0;
  }
  for (const Order& order : link_.take_orders()) take(order, mission, base, now);
  if (link_.take_stop()) {
    forget_next("stopped before it began");
    mission.stop();
    const std::string by = link_.stopped_by();
    say(now, by.empty() ? "stop" : by + ": stop");
  }
  if (by_console_ && !mission.finished() && !mission.paused() && !link_.is_held(clock)) {
    mission.pause();
    say(now, "paused: no client has control any more");
  }
  if (mission.finished()) start_next(mission);
}

void OperatorSession::start_next(Mission& mission) {
  if (next_goals_.empty() && !charges_next_) return;
  if (charges_next_) {
    charging_->begin(mission);
  } else {
    mission.start(next_goals_);
  }
  ticket_ = std::exchange(next_ticket_, 0);
  next_goals_.clear();
  charges_next_ = false;
  by_console_ = true;
}

void OperatorSession::forget_next(const std::string& why) {
  end_drive(std::exchange(next_ticket_, 0), why);
  next_goals_.clear();
  charges_next_ = false;
}

/// `why` is empty for one that arrived.
void OperatorSession::end_drive(std::uint64_t ticket, const std::string& why) {
  constexpr std::size_t most_kept = 16;
  if (ticket == 0) return;
  ended_.push_back({.ticket = ticket, .arrived = why.empty(), .why = why});
  if (ended_.size() > most_kept) ended_.pop_front();
}

void OperatorSession::take(const Order& order, Mission& mission, BaseDriver& base, Stamp now) {
  const auto say_by = [&](const std::string& words) { say(now, order.by + ": " + words); };
  if (const auto* go = std::get_if<GoOrder>(&order.what)) {
    take(*go, mission);
    say_by((go->is_more ? "then go to " : "go to ") + in_words(go->goals));
  } else if (std::holds_alternative<PauseOrder>(order.what)) {
    mission.pause();
    say_by("pause");
  } else if (std::holds_alternative<ResumeOrder>(order.what)) {
    mission.resume();
    by_console_ = true;
    say_by("resume");
  } else if (std::holds_alternative<ClearFaultOrder>(order.what)) {
    say_by(base.resume(now) ? "clear the fault" : "clear the fault: its cause is still there");
  } else if (const auto* place = std::get_if<PlaceOrder>(&order.what)) {
    const Pose2& pose = place->map_from_base;
    const bool done = mission.finished() && mission.place_robot(pose);
    say_by(fmt::format("set pose to ({:.2f}, {:.2f}, {:.0f}°){}", pose.position_m.x(), pose.position_m.y(),
                       degrees(pose.yaw_rad), done ? "" : ": not now"));
  } else if (std::holds_alternative<ChargeOrder>(order.what)) {
    if (charging_ == nullptr) return say_by("charge: the site has no dock");
    forget_next("the robot was sent to charge before it began");
    charges_next_ = true;
    mission.stop();
    say_by("charge");
  } else if (const auto* set = std::get_if<PlacesOrder>(&order.what)) {
    if (charging_ != nullptr && set->map_from_dock) charging_->dock_moved(*set->map_from_dock);
    zones_ = std::make_shared<const Zones>(set->zones);
    say_by(fmt::format("zones: {} keep-outs, {} speed zones", zones_->keep_out.size(),
                       zones_->speed_zones.size()));
  } else if (const auto* steer = std::get_if<SteerOrder>(&order.what)) {
    if (!mission.finished()) {  // the present drive ends first
      if (mission.phase() != MissionPhase::stopping) mission.stop();
      return;
    }
    if (mission.phase() != MissionPhase::by_hand) say_by("drive by hand");
    mission.steer(steer->wanted, now + steering_holds);
  }
}

/// Behind the goals of a drive that someone else has begun, too: who has control answers for all of it.
void OperatorSession::take(const GoOrder& order, Mission& mission) {
  const bool is_stopping = mission.phase() == MissionPhase::stopping;
  if (order.is_more && !mission.finished() && !is_stopping) {
    mission.append(order.goals);
    by_console_ = true;
    return;
  }
  if (order.is_more && is_stopping && !next_goals_.empty()) {
    next_goals_.insert(next_goals_.end(), order.goals.begin(), order.goals.end());
    return;
  }
  forget_next("another goal came before it began");
  next_goals_ = order.goals;
  next_ticket_ = order.ticket;
  mission.stop();
}

void OperatorSession::remember(const SensorInput& input, const MissionStep& step, const Mission& mission) {
  if (!step.navigation.fixes.empty()) last_fix_ = step.navigation.fixes.back();
  if (!input.frames.empty()) last_frame_ = input.frames.back();
  if (const std::string words = in_words(mission, step.event); !words.empty()) say(input.now, words);
  if (step.event == MissionEvent::goal_failed) {
    end_drive(std::exchange(ticket_, 0), mission.failure());
  } else if (step.event == MissionEvent::goal_arrived && mission.finished()) {
    end_drive(std::exchange(ticket_, 0), {});
  }
  if (std::string words = condition_of(input, step.navigation); words != condition_) {
    say(input.now, words);
    condition_ = std::move(words);
  }
}

void OperatorSession::publish(const SensorInput& input, const MissionStep& step, const Mission& mission,
                              const std::function<std::optional<TrueError>()>& error) {
  remember(input, step, mission);
  if (!link_.wants_state()) return;
  if (mission.finished()) {
    path_.reset();
  } else if (!path_ || path_->waypoints_m != mission.path().waypoints_m) {
    path_ = std::make_shared<const Path>(mission.path());
  }
  const NavigationStep& navigation = step.navigation;
  RobotState state{.now = input.now,
                   .estimate = navigation.estimate,
                   .stop = navigation.stop,
                   .slowed_by = navigation.slowed_by,
                   .commanded = navigation.command,
                   .measured = input.base.measured,
                   .phase = mission.phase(),
                   .goals = mission.goals(),
                   .current = mission.current(),
                   .path = path_,
                   .base = input.base.state,
                   .fault = input.base.fault,
                   .fault_details = input.base.details,
                   .charging = charging_ != nullptr ? charging_->state() : ChargingState::none,
                   .distrusted = navigation.distrusted,
                   .frame = last_frame_,
                   .error = error ? error() : std::nullopt,
                   .events = {events_.begin(), events_.end()},
                   .ended = {ended_.begin(), ended_.end()}};
  if (input.base.system && input.base.system->battery_v > 0.0) state.battery_v = input.base.system->battery_v;
  if (auto seen = mission.seen(input.now))
    state.seen = std::make_shared<const SeenSurroundings>(std::move(*seen));
  if (last_fix_) {
    state.markers = last_fix_->fix.ids;
    state.confidence = last_fix_->fix.confidence;
    state.last_seen = last_fix_->fix.stamp;
  }
  link_.publish(std::move(state));
}

}  // namespace lodestar
