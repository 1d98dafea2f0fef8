#include "app/navigation/mission.hpp"

#include <cmath>
#include <fmt/format.h>

#include "control/travel_time.hpp"

namespace lodestar {
namespace {

bool at_rest(const BaseFeedback& base) {
  constexpr double still_mps = 0.003;
  constexpr double still_radps = 0.01;
  return base.measured && std::abs(base.measured->forward_mps) <= still_mps &&
         std::abs(base.measured->turn_radps) <= still_radps;
}

}  // namespace

std::string_view to_string(MissionPhase phase) {
  switch (phase) {
    case MissionPhase::idle:
      return "waiting for a goal";
    case MissionPhase::starting:
      return "about to start";
    case MissionPhase::driving:
      return "driving";
    case MissionPhase::settling:
      return "coming to rest at the goal";
    case MissionPhase::waiting_for_base:
      return "waiting for the base";
    case MissionPhase::paused:
      return "paused";
    case MissionPhase::stopping:
      return "stopping";
  }
  return "";
}

Mission::Mission(const KnownWorld& world, const NavigationOptions& navigation, std::vector<Goal> goals,
                 const MissionOptions& options)
    : navigation_(world, navigation),
      goals_(std::move(goals)),
      options_(options),
      drive_options_(navigation.drive) {}

MissionStep Mission::step(const SensorInput& input) {
  NavigationStep step = navigation_.step(input);
  const MissionEvent event = finished() ? MissionEvent::none : advance(input, step);
  last_step_ = input.now;
  return {.navigation = std::move(step), .event = event};
}

MissionEvent Mission::advance(const SensorInput& input, const NavigationStep& step) {
  if (step.stop && is_for_good(*step.stop)) return fail(input.now, std::string(to_string(*step.stop)));
  switch (state_) {
    case State::starting:
      return start_goal(input, step);
    case State::driving:
      return watch_drive(input, step);
    case State::settling:
      return settle(input, step);
    case State::held:
      return hold(input);
    case State::stopping:
      return come_to_rest(input);
  }
  return MissionEvent::none;
}

void Mission::start(std::vector<Goal> goals) {
  goals_ = std::move(goals);
  current_ = 0;
  path_ = {};
  state_ = State::starting;
  since_.reset();
  paused_ = false;
}

void Mission::stop() {
  if (finished()) return;
  navigation_.look_for_markers(false);
  navigation_.cancel();
  state_ = State::stopping;
  paused_ = false;
}

void Mission::pause() {
  if (finished() || state_ == State::stopping) return;
  navigation_.pause();
  paused_ = true;
}

void Mission::resume() {
  navigation_.resume();
  paused_ = false;
}

MissionPhase Mission::phase() const {
  if (finished()) return MissionPhase::idle;
  if (paused_) return MissionPhase::paused;
  switch (state_) {
    case State::starting:
      return MissionPhase::starting;
    case State::driving:
      return MissionPhase::driving;
    case State::settling:
      return MissionPhase::settling;
    case State::held:
      return MissionPhase::waiting_for_base;
    case State::stopping:
      break;
  }
  return MissionPhase::stopping;
}

MissionEvent Mission::come_to_rest(const SensorInput& input) {
  if (input.base.state == BaseState::ready && !at_rest(input.base)) return MissionEvent::none;
  goals_.resize(current_ + 1);
  return fail(input.now, "stopped by the operator");
}

MissionEvent Mission::start_goal(const SensorInput& input, const NavigationStep& step) {
  if (!since_) since_ = input.now;
  if (input.base.state == BaseState::fault && options_.hold_on_base_fault) return hold(input);
  if (paused_) {
    navigation_.look_for_markers(false);
    since_.reset();
    return MissionEvent::none;
  }
  const bool may_start = !step.stop && input.base.state == BaseState::ready && at_rest(input.base);
  if (!may_start) {
    navigation_.look_for_markers(input.base.state == BaseState::ready);
    if (input.now - *since_ < options_.max_wait_for_start) return MissionEvent::none;
    if (input.base.state != BaseState::ready) {
      return fail(input.now, fmt::format("the base is not ready: {}",
                                         to_string(input.base.fault.value_or(BaseFault::feedback_lost))));
    }
    return fail(input.now,
                fmt::format("cannot start: {}", step.stop ? to_string(*step.stop) : "not at rest"));
  }
  navigation_.look_for_markers(false);
  state_ = State::driving;
  since_.reset();
  drive_ends_ = input.now + options_.max_time_more;
  const std::optional<RouteUpdate> route = navigation_.go_to(goals_[current_]);
  return route ? take_route(input, step, *route) : MissionEvent::none;
}

MissionEvent Mission::take_route(const SensorInput& input, const NavigationStep& step,
                                 const RouteUpdate& route) {
  if (!route.failure) {
    follow_path(input, step, route.route.path);
    return MissionEvent::path_planned;
  }
  const std::string_view why = to_string(*route.failure);
  const bool never_had_one = route.change == RouteChange::new_goal;
  return fail(input.now,
              never_had_one ? std::string(why) : fmt::format("{}: {}", to_string(route.change), why));
}

void Mission::follow_path(const SensorInput& input, const NavigationStep& step, Path path) {
  path_ = std::move(path);
  ideal_s_ = ideal_travel_time_s(path_, step.estimate->map_from_base.yaw_rad, goals_[current_].heading_rad,
                                 drive_options_);
  drive_ends_ = input.now + from_seconds(options_.max_time_factor * ideal_s_) + options_.max_time_more;
}

MissionEvent Mission::watch_drive(const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault) return hold(input);
  if (step.reroute) return take_route(input, step, *step.reroute);
  if (navigation_.arrived()) {
    state_ = State::settling;
    since_.reset();
    return MissionEvent::none;
  }
  if (paused_) {
    drive_ends_ += input.now - last_step_;
    since_.reset();
    return MissionEvent::none;
  }
  if (input.now > drive_ends_) return fail(input.now, "no progress: the robot is stuck");
  if (!step.stop) {
    since_.reset();
    return MissionEvent::none;
  }
  if (!since_) since_ = input.now;
  if (input.now - *since_ < options_.max_stop) return MissionEvent::none;
  return fail(input.now, fmt::format("stopped for too long: {}", to_string(*step.stop)));
}

/// Where a stopped robot stands is not where its path is: once the base is ready again, it plans anew.
MissionEvent Mission::hold(const SensorInput& input) {
  const bool is_hopeless = input.base.fault == BaseFault::guard_lost;
  if (!options_.hold_on_base_fault || is_hopeless) {
    return fail(input.now, fmt::format("the base was stopped: {}",
                                       input.base.fault ? to_string(*input.base.fault) : "no cause known"));
  }
  navigation_.halt();
  state_ = input.base.state == BaseState::ready ? State::starting : State::held;
  since_.reset();
  return MissionEvent::none;
}

/// What the wheels alone have told is no arrival: they may have slipped on the last of the way.
MissionEvent Mission::settle(const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault) return hold(input);
  if (!since_ || !at_rest(input.base)) since_ = input.now;
  const Duration settled = input.now - *since_;
  if (settled < options_.settle) return MissionEvent::none;
  if (step.stop || step.rolled_unseen_m > options_.max_rolled_unseen_m) {
    if (settled < options_.max_stop) return MissionEvent::none;
    return fail(input.now, fmt::format("cannot see that it has arrived: {}",
                                       step.stop ? to_string(*step.stop) : "no marker is in view"));
  }
  const double distance_m = (step.estimate->map_from_base.position_m - goals_[current_].position_m).norm();
  if (distance_m > options_.max_distance_at_arrival_m) {
    if (++attempt_ >= options_.attempts) return fail(input.now, "does not come near enough to the goal");
    state_ = State::starting;
    since_.reset();
    return MissionEvent::none;
  }
  return end_goal(input.now, MissionEvent::goal_arrived);
}

MissionEvent Mission::end_goal(Stamp now, MissionEvent event) {
  ++current_;
  paused_ = false;
  attempt_ = 0;
  state_ = State::starting;
  since_ = now;
  return event;
}

MissionEvent Mission::fail(Stamp now, std::string why) {
  failure_ = std::move(why);
  navigation_.halt();
  return end_goal(now, MissionEvent::goal_failed);
}

}  // namespace lodestar
