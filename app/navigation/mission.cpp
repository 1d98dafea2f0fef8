#include "app/navigation/mission.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "control/travel_time.hpp"

namespace lodestar {
namespace {

/// Of the time that was planned, at this share of the full speed.
Duration time_lost(Duration elapsed, double share_of_speed) {
  return from_seconds((1.0 - share_of_speed) * seconds(elapsed));
}

}  // namespace

std::string_view to_string(MissionPhase phase) {
  switch (phase) {
    case MissionPhase::idle:
      return "waiting for a goal";
    case MissionPhase::by_hand:
      return "driven by hand";
    case MissionPhase::starting:
      return "about to start";
    case MissionPhase::driving:
      return "driving";
    case MissionPhase::settling:
      return "coming to rest at the goal";
    case MissionPhase::at_stop:
      return "at a stop of the mission";
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
  wheels_.take(input.base.travel);
  NavigationStep step = navigation_.step(input);
  rest_.add(input.now, input.base.measured, step.estimate);
  const MissionEvent event = finished() ? MissionEvent::none : advance(input, step);
  last_step_ = input.now;
  return {.navigation = std::move(step), .event = event};
}

MissionEvent Mission::advance(const SensorInput& input, const NavigationStep& step) {
  if (step.stop && is_latched(*step.stop)) return fail(input.now, std::string(to_string(*step.stop)));
  // Visits a copy, as the steps assign state_.
  return std::visit([&](const auto& state) { return advance(state, input, step); }, State(state_));
}

void Mission::start(std::vector<Goal> goals) {
  goals_ = std::move(goals);
  current_ = 0;
  failed_to_ = 0;
  path_ = {};
  state_ = Starting{};
  paused_ = false;
  steered_until_.reset();
}

/// The trip under way becomes longer only where its last goal is one that is passed.
void Mission::append(std::vector<Goal> goals) {
  if (finished()) {
    state_ = Starting{};
    paused_ = false;
    steered_until_.reset();
  }
  const std::size_t before = finished() ? 0 : trip().size();
  goals_.insert(goals_.end(), goals.begin(), goals.end());
  if (!std::holds_alternative<Driving>(state_)) return;
  const std::vector<Goal> now = trip();
  if (now.size() > before) navigation_.extend(std::span(now).subspan(before));
}

void Mission::pass_last() {
  const bool is_on_way = std::holds_alternative<Starting>(state_) || std::holds_alternative<Driving>(state_);
  if (!finished() && is_on_way && !goals_.back().heading_rad) goals_.back().passes = true;
}

std::vector<Goal> Mission::trip() const {
  const auto begin = goals_.begin() + static_cast<std::ptrdiff_t>(current_);
  const auto rest = std::ranges::find(begin, goals_.end(), false, &Goal::passes);
  return {begin, rest == goals_.end() ? rest : std::next(rest)};
}

void Mission::stop() {
  if (phase() == MissionPhase::by_hand) {
    navigation_.cancel();
    steered_until_.reset();
  }
  if (finished()) return;
  navigation_.look_for_markers(false);
  navigation_.cancel();
  state_ = Stopping{};
  paused_ = false;
}

void Mission::pause() {
  if (finished() || std::holds_alternative<Stopping>(state_)) return;
  navigation_.pause();
  paused_ = true;
}

void Mission::resume() {
  navigation_.resume();
  paused_ = false;
}

void Mission::steer(const BodyVelocity& wanted, Stamp until) {
  navigation_.steer(wanted, until);
  steered_until_ = until;
}

MissionPhase Mission::phase() const {
  if (finished())
    return steered_until_ && last_step_ <= *steered_until_ ? MissionPhase::by_hand : MissionPhase::idle;
  if (paused_) return MissionPhase::paused;
  if (std::holds_alternative<Starting>(state_)) return MissionPhase::starting;
  if (std::holds_alternative<Driving>(state_)) return MissionPhase::driving;
  if (std::holds_alternative<Settling>(state_)) return MissionPhase::settling;
  if (std::holds_alternative<AtStop>(state_)) return MissionPhase::at_stop;
  if (std::holds_alternative<Held>(state_)) return MissionPhase::waiting_for_base;
  return MissionPhase::stopping;
}

MissionEvent Mission::advance(Stopping state, const SensorInput& input, const NavigationStep&) {
  if (!state.since) state.since = input.now;
  state_ = state;
  const bool waits = input.now - *state.since < options_.max_unrest;
  if (input.base.state == BaseState::ready && !at_rest() && waits) return MissionEvent::none;
  goals_.resize(current_ + 1);
  return fail(input.now, "stopped by the operator");
}

MissionEvent Mission::advance(Starting state, const SensorInput& input, const NavigationStep& step) {
  if (current_ < failed_to_) return fail(input.now, failure_);
  if (input.base.state == BaseState::fault && options_.hold_on_base_fault) return hold(input);
  if (paused_) {
    navigation_.look_for_markers(false);
    state_ = Starting{};
    return MissionEvent::none;
  }
  if (!state.since) state.since = input.now;
  state_ = state;
  const bool may_start = !step.stop && input.base.state == BaseState::ready && at_rest();
  if (!may_start) return wait_to_start(state, input, step);
  navigation_.look_for_markers(false);
  navigation_.go_over(trip());
  trip_start_ = current_;
  state_ = Driving{.ends = input.now + options_.max_time_more, .stopped = std::nullopt};
  return MissionEvent::none;
}

MissionEvent Mission::wait_to_start(const Starting& state, const SensorInput& input,
                                    const NavigationStep& step) {
  const bool is_ready = input.base.state == BaseState::ready;
  navigation_.look_for_markers(is_ready);
  if (input.now - *state.since < options_.max_wait_for_start) return MissionEvent::none;
  if (!is_ready) {
    const BaseFault missing = input.base.fault.value_or(BaseFault::feedback_lost);
    return fail(input.now, fmt::format("the base is not ready: {}", in_words(missing, input.base.details)));
  }
  return fail(input.now, fmt::format("cannot start: {}", step.stop ? std::string(to_string(*step.stop))
                                                                   : "not at rest, " + rest_.why_not()));
}

MissionEvent Mission::apply_route(Driving state, const SensorInput& input, const NavigationStep& step,
                                  const RouteUpdate& route) {
  if (route.failure) {
    const std::string_view why = to_string(*route.failure);
    const bool never_had_one = route.change == RouteChange::new_goal;
    return fail(input.now,
                never_had_one ? std::string(why) : fmt::format("{}: {}", to_string(route.change), why));
  }
  path_ = route.route.path;
  ideal_s_ = ideal_travel_time_s(path_, step.estimate->map_from_base.yaw_rad, route.route.goal_heading_rad,
                                 drive_options_);
  state.ends = input.now + from_seconds(options_.max_time_factor * ideal_s_) + options_.max_time_more;
  state_ = state;
  return MissionEvent::path_planned;
}

MissionEvent Mission::advance(Driving state, const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault) return hold(input);
  if (step.reroute) return apply_route(state, input, step, *step.reroute);
  if (trip_start_ + navigation_.passed() > current_) return end_pass();
  if (navigation_.arrived()) {
    state_ = Settling{};
    return MissionEvent::none;
  }
  if (paused_) {
    state_ = Driving{.ends = state.ends + (input.now - last_step_), .stopped = std::nullopt};
    return MissionEvent::none;
  }
  if (step.is_slowed) state.ends += input.now - last_step_;  // by others, who are not its fault
  if (is_hindered_too_long(input, step)) return fail(input.now, "people or things in the way for too long");
  if (step.zone_mps)
    state.ends += time_lost(input.now - last_step_, *step.zone_mps / drive_options_.max_forward_mps);
  if (input.now > state.ends) return fail(input.now, "no progress: the robot is stuck");
  const std::optional<Stopped> before = std::exchange(state.stopped, std::nullopt);
  if (step.stop) {
    const Duration patience = patience_with(*step.stop);
    state.stopped = before && before->patience == patience ? *before : Stopped{input.now, patience};
  }
  state_ = state;
  if (!state.stopped || input.now - state.stopped->since < state.stopped->patience) return MissionEvent::none;
  return fail(input.now, fmt::format("stopped for too long: {}", to_string(*step.stop)));
}

/// With people as long as while they let it creep; a thing that blocks the way is moved away soon, or not at
/// all.
Duration Mission::patience_with(StopReason reason) const {
  if (reason == StopReason::person_near) return options_.max_hindered;
  return waits_for_others(reason) ? options_.max_wait : options_.max_stop;
}

MissionEvent Mission::advance(Held, const SensorInput& input, const NavigationStep&) {
  return hold(input);
}

/// Drops the path, as the stopped robot may have left it, and replans once the base is ready again.
MissionEvent Mission::hold(const SensorInput& input) {
  const bool is_hopeless = input.base.fault == BaseFault::guard_lost;
  if (!options_.hold_on_base_fault || is_hopeless) {
    const std::string why =
        input.base.fault ? in_words(*input.base.fault, input.base.details) : "no cause known";
    return fail(input.now, fmt::format("the base was stopped: {}", why));
  }
  navigation_.halt();
  state_ = input.base.state == BaseState::ready ? State(Starting{}) : State(Held{});
  return MissionEvent::none;
}

bool Mission::is_hindered_too_long(const SensorInput& input, const NavigationStep& step) {
  if (!step.is_slowed || !step.estimate) return false;
  const double left_m = length_m(rest_of(path_, step.estimate->map_from_base.position_m));
  if (!left_m_ || left_m < *left_m_ - options_.progress_m) {
    left_m_ = left_m;
    hindered_ = Duration::zero();
  }
  hindered_ += input.now - last_step_;
  return hindered_ > options_.max_hindered;
}

/// The trip goes on, and its deadline with it.
MissionEvent Mission::end_pass() {
  ++current_;
  attempt_ = 0;
  hindered_ = Duration::zero();
  return MissionEvent::goal_passed;
}

/// Wheel odometry alone does not prove arrival: the wheels may have slipped.
MissionEvent Mission::advance(Settling state, const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault) return hold(input);
  if (goals_[current_].passes && step.estimate &&
      distance_to_goal_m(*step.estimate) <= options_.pass_within_m)
    return end_goal(input.now, MissionEvent::goal_passed);
  if (!state.since) state.since = input.now;
  if (!state.still_since || !at_rest()) state.still_since = input.now;
  const Duration settled = input.now - *state.still_since;
  if (settled >= options_.settle) state.since = input.now;
  state_ = state;
  if (settled < options_.settle) {
    if (input.now - *state.since < options_.max_unrest) return MissionEvent::none;
    return fail(input.now, fmt::format("does not come to rest at the goal: {}", rest_.why_not()));
  }
  if (step.stop || step.rolled_unseen_m > options_.max_rolled_unseen_m) {
    if (settled < options_.max_stop) return MissionEvent::none;
    return fail(input.now, fmt::format("cannot see that it has arrived: {}",
                                       step.stop ? to_string(*step.stop) : "no marker is in view"));
  }
  const double distance_m = distance_to_goal_m(*step.estimate);
  if (distance_m <= drive_options_.arrival_distance_m) return arrive(input.now);
  ++attempt_;
  if (attempt_ >= options_.attempts)
    return fail(input.now, fmt::format("not reached: {:.1f} mm from the goal after {} attempts, arrival is "
                                       "within {:.1f} mm",
                                       1e3 * distance_m, attempt_, 1e3 * drive_options_.arrival_distance_m));
  state_ = Starting{};
  return MissionEvent::none;
}

double Mission::distance_to_goal_m(const PoseEstimate& estimate) const {
  return (estimate.map_from_base.position_m - goals_[current_].position_m).norm();
}

MissionEvent Mission::end_goal(Stamp now, MissionEvent event) {
  ++current_;
  paused_ = false;
  attempt_ = 0;
  hindered_ = Duration::zero();
  left_m_.reset();
  state_ = Starting{.since = now};
  return event;
}

/// From where it stands, the robot would come to the goals after one on the way, and to those on a straight
/// line from it, by another way than was asked.
MissionEvent Mission::fail(Stamp now, std::string why) {
  failure_ = std::move(why);
  failed_to_ = current_ + trip().size();
  while (failed_to_ < goals_.size() && goals_[failed_to_].on_line) ++failed_to_;
  navigation_.halt();
  return end_goal(now, MissionEvent::goal_failed);
}

}  // namespace lodestar
