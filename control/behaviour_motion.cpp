#include <array>
#include <utility>

#include "control/behaviour.hpp"

namespace lodestar {
namespace {

using Reason = Braking::Reason;

struct Outcome {
  BodyVelocity command;
  BehaviourState state;
};

Outcome along_path(Trip trip, bool was_blocked, const Facts& facts, const Backtrack& places) {
  const BodyVelocity command = trip.drive.update(*facts.estimate, facts.elapsed, facts.limit);
  if (trip.drive.arrived()) return {command, Arrived{}};
  if (facts.room_ahead == RoomAhead::enough || trip.drive.phase() != DrivePhase::driving)
    return {command, Following{std::move(trip)}};
  if (facts.room_ahead == RoomAhead::none) {
    if (!was_blocked) trip.wanted = PlanRequest{.kind = PlanKind::review, .leg_from_here = true};
    return {command, Blocked{std::move(trip), false}};
  }
  if (can_go_back(facts, places)) return {command, Braking{std::move(trip), Reason::uncertain}};
  return {command, Blocked{std::move(trip), true}};
}

Outcome move(Following state, const Facts& facts, const BehaviourOptions&, Backtrack& places) {
  return along_path(std::move(state.trip), false, facts, places);
}

Outcome move(Blocked state, const Facts& facts, const BehaviourOptions&, Backtrack& places) {
  const bool was_blocked = !state.only_by_uncertainty;
  return along_path(std::move(state.trip), was_blocked, facts, places);
}

Outcome move(Braking state, const Facts& facts, const BehaviourOptions&, Backtrack&) {
  const BodyVelocity command = state.trip.drive.slow_down(facts.elapsed);
  if (state.reason == Reason::end && state.trip.drive.at_rest()) return {command, Standing{}};
  return {command, std::move(state)};
}

Outcome move(Searching state, const Facts& facts, const BehaviourOptions&, Backtrack& places) {
  const std::optional<double> turn_radps =
      state.look.update(facts.now, reason_to_stay(facts, places), facts.turned_rad);
  const BodyVelocity command = state.trip.drive.turn_around(turn_radps.value_or(0.0), facts.elapsed);
  return {command, std::move(state)};
}

/// Follows the way back. After a stop or an obstacle it ends only at rest, as either may be gone before.
Outcome move(Backtracking state, const Facts& facts, const BehaviourOptions& options, Backtrack& places) {
  RotateThenDrive& way = state.way;
  const bool is_blocked = !facts.stop_on_backtrack && way.phase() == DrivePhase::driving &&
                          facts.limit_on_backtrack.forward_mps < options.drive.min_forward_mps;
  const bool must_stop = facts.stop_on_backtrack || is_blocked;
  const BodyVelocity command = must_stop
                                   ? way.slow_down(facts.elapsed)
                                   : way.update(*facts.estimate, facts.elapsed, facts.limit_on_backtrack);
  if (way.arrived()) places.reached_place();
  if (!way.arrived() && !(must_stop && way.at_rest())) return {command, std::move(state)};
  state.trip.drive.take_over_from(way);
  return {command, Braking{std::move(state.trip), Reason::replan}};
}

Outcome move(Paused state, const Facts& facts, const BehaviourOptions&, Backtrack&) {
  RotateThenDrive& drive = state.way_back ? *state.way_back : state.trip.drive;
  const BodyVelocity command = drive.slow_down(facts.elapsed);
  return {command, std::move(state)};
}

Outcome move(Asking state, const Facts& facts, const BehaviourOptions&, Backtrack&) {
  const BodyVelocity command = state.trip.drive.slow_down(facts.elapsed);
  return {command, std::move(state)};
}

/// Where the pose is known, the map's obstacles ahead count too.
Outcome move(Steered state, const Facts& facts, const BehaviourOptions& options, Backtrack&) {
  const SpeedLimit limit = facts.stop ? SpeedLimit{} : facts.limit;
  const BodyVelocity wanted = within(facts.steering.value_or(BodyVelocity{}), limit, options.steering);
  const BodyVelocity command = state.trip.drive.steer(wanted, facts.elapsed);
  return {command, std::move(state)};
}

template <typename Resting>
Outcome move(Resting state, const Facts&, const BehaviourOptions&, Backtrack&) {
  return {BodyVelocity{}, state};
}

/// What moves the robot; null where nothing does.
RotateThenDrive* drive_in(BehaviourState& state) {
  if (auto* backtracking = std::get_if<Backtracking>(&state)) return &backtracking->way;
  auto* paused = std::get_if<Paused>(&state);
  if (paused != nullptr && paused->way_back) return &*paused->way_back;
  return std::visit(
      [](auto& some) -> RotateThenDrive* {
        if constexpr (requires { some.trip; }) return &some.trip.drive;
        return nullptr;
      },
      state);
}

bool goes_back(const BehaviourState& state) {
  const auto* braking = std::get_if<Braking>(&state);
  const auto* paused = std::get_if<Paused>(&state);
  return std::holds_alternative<Backtracking>(state) ||
         (braking != nullptr && braking->reason == Reason::marker_found) ||
         (paused != nullptr && paused->way_back);
}

/// Is the robot held up by pose uncertainty alone, without a reason to stop?
bool is_uncertain(const BehaviourState& state) {
  if (const auto* blocked = std::get_if<Blocked>(&state)) return blocked->only_by_uncertainty;
  const auto* braking = std::get_if<Braking>(&state);
  if (braking == nullptr) return false;
  const std::optional<PlanRequest>& wanted = braking->trip.wanted;
  return braking->reason == Reason::uncertain ||
         (braking->reason == Reason::replan && wanted && wanted->kind == PlanKind::another_way);
}

}  // namespace

Moved moved(Behaviour before, const Facts& facts, const BehaviourOptions& options) {
  Outcome outcome = std::visit(
      [&](auto&& state) { return move(std::forward<decltype(state)>(state), facts, options, before.places); },
      std::move(before.state));
  return {outcome.command, {std::move(outcome.state), std::move(before.places)}};
}

Behaviour after_sending(Behaviour moved, const BodyVelocity& sent, Duration elapsed) {
  if (RotateThenDrive* const drive = drive_in(moved.state)) drive->was_sent(sent, elapsed);
  return moved;
}

Shown shown(const Behaviour& decided, const Behaviour& moved, const Facts& facts) {
  if (std::holds_alternative<Steered>(decided.state)) return {};
  if (goes_back(decided.state)) return {.stop = facts.stop_on_backtrack, .backtracks = true};
  if (const std::optional<StopReason> stop = reason_to_stay(facts, decided.places)) return {.stop = stop};
  if (is_uncertain(moved.state)) return {.stop = StopReason::pose_uncertain};
  if (std::holds_alternative<Blocked>(moved.state)) return {.stop = StopReason::way_blocked};
  return {};
}

std::optional<StopReason> reason_to_stay(const Facts& facts, const Backtrack& places) {
  if (!facts.stop && places.found_no_marker()) return StopReason::pose_stale;
  return facts.stop;
}

bool can_go_back(const Facts& facts, const Backtrack& places) {
  return !facts.stop_on_backtrack && places.possible();
}

std::string_view to_string(const BehaviourState& state) {
  if (const auto* braking = std::get_if<Braking>(&state)) {
    constexpr std::array names{"Braking: stop", "Braking: uncertain", "Braking: replan",
                               "Braking: marker found", "Braking: end"};
    return names.at(static_cast<std::size_t>(braking->reason));
  }
  if (const auto* asking = std::get_if<Asking>(&state)) {
    constexpr std::array names{"Asking: extension",   "Asking: review",   "Asking: replan",
                               "Asking: another way", "Asking: new goal", "Asking: way back"};
    return names.at(static_cast<std::size_t>(asking->request.kind));
  }
  constexpr std::array names{"Standing",  "Arrived", "Following",    "Blocked", "",
                             "Searching", "",        "Backtracking", "Paused",  "Steered"};
  return names.at(state.index());
}

}  // namespace lodestar
