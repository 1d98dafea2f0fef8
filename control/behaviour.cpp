#include "control/behaviour.hpp"

#include <type_traits>
#include <utility>

namespace lodestar {
namespace {

using Reason = Braking::Reason;

/// Inputs of a transition.
struct Circumstances {
  const Facts& facts;
  const BehaviourOptions& options;
  const Backtrack& places;
  std::optional<StopReason> stop;

  [[nodiscard]] bool can_go_back() const { return lodestar::can_go_back(facts, places); }
  [[nodiscard]] bool marker_can_end_stop() const { return stop && can_a_marker_end(*stop); }
};

void remember(Backtrack& places, const Facts& facts) {
  if (!facts.estimate) return;
  const Vec2& here_m = facts.estimate->map_from_base.position_m;
  if (facts.sees_marker) {
    places.saw_marker_at(here_m);
  } else {
    places.saw_no_marker_at(here_m);
  }
}

bool has_path(const Trip& trip) {
  return !trip.drive.path_ahead().waypoints_m.empty();
}

bool has_goal(const Trip& trip) {
  return has_path(trip) || trip.wanted;
}

/// Keeps the more urgent request, which includes the other.
void want(Trip& trip, const PlanRequest& request) {
  if (!trip.wanted || trip.wanted->kind < request.kind) trip.wanted = request;
}

/// An obstacle lies between the robot and the leg's end, maybe beside the leg itself: check from the robot.
PlanRequest review_by(const Blocked& blocked) {
  return {.kind = PlanKind::review, .leg_from_here = !blocked.only_by_uncertainty};
}

bool must_ask_first(const Trip& trip) {
  return trip.wanted && trip.wanted->kind != PlanKind::review;
}

template <typename State>
auto trip_in(State& state) {
  using Found = std::conditional_t<std::is_const_v<State>, const Trip*, Trip*>;
  return std::visit(
      [](auto& some) -> Found {
        if constexpr (requires { some.trip; }) return &some.trip;
        return nullptr;
      },
      state);
}

/// The trip, with its drive taking over the present speed.
Trip moving_trip(BehaviourState state) {
  Trip trip = std::move(*trip_in(state));
  if (const auto* backtracking = std::get_if<Backtracking>(&state))
    trip.drive.take_over_from(backtracking->way);
  const auto* paused = std::get_if<Paused>(&state);
  if (paused != nullptr && paused->way_back) trip.drive.take_over_from(*paused->way_back);
  return trip;
}

BehaviourState at_rest_asking(Trip trip) {
  if (!trip.drive.at_rest()) return Braking{std::move(trip), Reason::replan};
  const PlanRequest request = *trip.wanted;
  return Asking{std::move(trip), request};
}

bool is_off_path(const Trip& trip, const Circumstances& at) {
  return distance_to_path_m(trip.drive.path_ahead(), at.facts.estimate->map_from_base.position_m) >
         at.options.left_path_m;
}

/// Follows the path; asks first for any plan that it needs.
BehaviourState go_on(Trip trip, const Circumstances& at) {
  if (must_ask_first(trip)) return at_rest_asking(std::move(trip));
  if (is_off_path(trip, at)) want(trip, {.kind = PlanKind::review});
  return Following{std::move(trip)};
}

/// When a marker in view would end the stop, the robot backtracks or spins to find one.
BehaviourState stop_or_go_on(Trip trip, const Circumstances& at) {
  if (!at.stop) return go_on(std::move(trip), at);
  if (!at.marker_can_end_stop()) return Braking{std::move(trip), Reason::stop};
  if (at.can_go_back()) return Braking{std::move(trip), Reason::uncertain};
  return Searching{std::move(trip), Spin(at.options.spin)};
}

bool is_steered(const Circumstances& at) {
  return at.facts.steering && may_be_steered(at.stop);
}

Trip no_trip(const Circumstances& at) {
  return {RotateThenDrive({}, std::nullopt, at.options.drive), std::nullopt, false};
}

/// Without a path, the robot searches for a marker if allowed to.
template <typename Resting>
BehaviourState search_or_stay(Resting state, const Circumstances& at) {
  if (!at.facts.may_look_around || !at.marker_can_end_stop()) return state;
  return Searching{no_trip(at), Spin(at.options.spin)};
}

BehaviourState next(Standing state, const Circumstances& at) {
  if (is_steered(at)) return Steered{no_trip(at)};
  return search_or_stay(state, at);
}

BehaviourState next(Arrived state, const Circumstances& at) {
  if (is_steered(at)) return Steered{no_trip(at)};
  return search_or_stay(state, at);
}

BehaviourState next(Steered state, const Circumstances& at) {
  if (is_steered(at)) return state;
  return Braking{std::move(state.trip), Reason::end};
}

BehaviourState next(Following state, const Circumstances& at) {
  return stop_or_go_on(std::move(state.trip), at);
}

BehaviourState next(Blocked state, const Circumstances& at) {
  if (at.stop || must_ask_first(state.trip)) return stop_or_go_on(std::move(state.trip), at);
  if (is_off_path(state.trip, at)) want(state.trip, review_by(state));
  return state;
}

/// At rest: goes on when there is room after all, as braking may have carried it past the narrow place. Else
/// asks for another path with wider margins, once per goal; after that, or under a stop, backtracks.
BehaviourState stay_uncertain(Braking state, const Circumstances& at) {
  Trip& trip = state.trip;
  if (at.facts.sees_marker && !at.marker_can_end_stop()) return stop_or_go_on(std::move(trip), at);
  const bool stands = trip.drive.at_rest();
  if (!at.stop && stands && at.facts.room_ahead == RoomAhead::enough) return go_on(std::move(trip), at);
  if (at.stop && !at.can_go_back() && !at.marker_can_end_stop()) return state;  // until that stop is over
  if (!at.can_go_back()) return stop_or_go_on(std::move(trip), at);
  if (!stands) return state;
  if (!at.stop && !trip.prefers_wide_margins) {
    trip.prefers_wide_margins = true;
    want(trip, {.kind = PlanKind::another_way});
    return Braking{std::move(trip), Reason::replan};
  }
  return Asking{std::move(trip), {.kind = PlanKind::way_back, .goal_m = *at.places.place_m()}};
}

BehaviourState next(Braking state, const Circumstances& at) {
  switch (state.reason) {
    case Reason::stop:
    case Reason::replan:
      return stop_or_go_on(std::move(state.trip), at);
    case Reason::uncertain:
      return stay_uncertain(std::move(state), at);
    case Reason::marker_found:
      if (state.trip.drive.at_rest()) return stop_or_go_on(std::move(state.trip), at);
      return state;
    case Reason::end:
      if (is_steered(at)) return Steered{std::move(state.trip)};
      break;
  }
  return state;
}

BehaviourState next(Searching state, const Circumstances& at) {
  if (has_goal(state.trip)) {
    if (at.marker_can_end_stop() && !at.can_go_back()) return state;
    return stay_uncertain({std::move(state.trip), Reason::uncertain}, at);
  }
  if (is_steered(at)) return Steered{std::move(state.trip)};
  if (at.facts.may_look_around && at.marker_can_end_stop()) return state;
  return Braking{std::move(state.trip), Reason::end};
}

/// A stop that forbids the requested motion ends the request; the robot asks again afterwards.
BehaviourState next(Asking state, const Circumstances& at) {
  const bool asks_for_way_back = state.request.kind == PlanKind::way_back;
  if (!(asks_for_way_back ? at.facts.stop_on_backtrack : at.stop)) return state;
  if (asks_for_way_back) return stay_uncertain({std::move(state.trip), Reason::uncertain}, at);
  return stop_or_go_on(std::move(state.trip), at);
}

/// A marker seen far from the backtrack's target ends the backtrack early.
BehaviourState next(Backtracking state, const Circumstances& at) {
  const std::optional<PoseEstimate>& estimate = at.facts.estimate;
  if (at.facts.sees_marker && estimate && at.places.is_far_from_its_end(estimate->map_from_base.position_m))
    return Braking{moving_trip(std::move(state)), Reason::marker_found};
  return state;
}

BehaviourState next(Paused state, const Circumstances& at) {
  if (at.facts.wish == Wish::pause) return state;
  if (state.way_back) return next(Backtracking{std::move(state.trip), std::move(*state.way_back)}, at);
  return stop_or_go_on(std::move(state.trip), at);
}

BehaviourState paused(BehaviourState state) {
  if (std::holds_alternative<Paused>(state)) return state;
  if (auto* backtracking = std::get_if<Backtracking>(&state))
    return Paused{std::move(backtracking->trip), std::move(backtracking->way)};
  return Paused{std::move(*trip_in(state)), std::nullopt};
}

PlanRequest review_of(const BehaviourState& state) {
  const auto* blocked = std::get_if<Blocked>(&state);
  return blocked != nullptr ? review_by(*blocked) : PlanRequest{.kind = PlanKind::review};
}

/// Transitions common to all states with a trip come first.
BehaviourState next(BehaviourState state, const Circumstances& at) {
  const Facts& facts = at.facts;
  if (Trip* const trip = trip_in(state)) {
    const bool is_over = at.stop && is_latched(*at.stop);
    if (is_over || facts.wish == Wish::halt) return Standing{};
    if (facts.wish == Wish::cancel) return Braking{moving_trip(std::move(state)), Reason::end};
    if (facts.map_changed && has_path(*trip)) want(*trip, review_of(state));
    if (facts.wish == Wish::pause && is_under_way(state)) return paused(std::move(state));
  }
  return std::visit([&](auto&& some) { return next(std::forward<decltype(some)>(some), at); },
                    std::move(state));
}

/// What a trip under way asks for while it goes on.
std::optional<PlanRequest> wanted_on_the_way(const Trip& trip) {
  if (trip.wanted || trip.goals_beyond == 0 || !has_path(trip)) return trip.wanted;
  return PlanRequest{.kind = PlanKind::extension};
}

/// Without a way on, the trip ends where it was to end.
void extend(Trip& trip, const PlanAnswer& answer) {
  trip.goals_beyond = 0;
  if (const auto* more = std::get_if<PathExtended>(&answer))
    trip.drive.extend(more->tail, more->passes_end, more->final_heading_rad, more->blend_corridor_m);
}

/// A review changes nothing unless the path must be replaced.
template <typename Driving>
BehaviourState with_review(Driving state, const PlanAnswer& answer) {
  Trip& trip = state.trip;
  if (!trip.wanted) {
    extend(trip, answer);
    return state;
  }
  if (!std::holds_alternative<PathMustBeReplaced>(answer)) {
    trip.wanted.reset();
    return state;
  }
  trip.wanted->kind = PlanKind::replan;
  return at_rest_asking(std::move(trip));
}

/// Backtracks, and then asks for another path than the one without markers.
BehaviourState with_way_back(Asking state, const PlanAnswer& answer, Backtrack& places) {
  places.begin();
  want(state.trip, {.kind = PlanKind::another_way});
  if (const auto* found = std::get_if<PathFound>(&answer))
    return Backtracking{std::move(state.trip), found->drive};
  return Braking{std::move(state.trip), Reason::replan};
}

/// Without a new path, the robot follows the old one if that is still valid; else it stands.
BehaviourState with_plan(Asking state, const PlanAnswer& answer, Backtrack& places) {
  if (state.request.kind == PlanKind::way_back) return with_way_back(std::move(state), answer, places);
  Trip& trip = state.trip;
  trip.wanted.reset();
  const bool holds =
      std::holds_alternative<PathStaysValid>(answer) || state.request.kind == PlanKind::another_way;
  if (const auto* found = std::get_if<PathFound>(&answer)) {
    trip.drive = found->drive;
    trip.goals_beyond = 0;
  } else if (!holds) {
    return Standing{};
  }
  return Following{std::move(trip)};
}

}  // namespace

Behaviour decided(Behaviour before, const Facts& facts, const BehaviourOptions& options) {
  remember(before.places, facts);
  const std::optional<StopReason> stop = reason_to_stay(facts, before.places);
  before.state = next(std::move(before.state), {facts, options, before.places, stop});
  return before;
}

std::optional<PlanRequest> plan_wanted(const BehaviourState& state) {
  if (const auto* asking = std::get_if<Asking>(&state)) return asking->request;
  if (const auto* following = std::get_if<Following>(&state)) return wanted_on_the_way(following->trip);
  if (const auto* blocked = std::get_if<Blocked>(&state)) return wanted_on_the_way(blocked->trip);
  return std::nullopt;
}

const Trip* trip_of(const BehaviourState& state) {
  return trip_in(state);
}

bool is_under_way(const BehaviourState& state) {
  const Trip* const trip = trip_of(state);
  const auto* braking = std::get_if<Braking>(&state);
  return trip != nullptr && has_goal(*trip) && !(braking != nullptr && braking->reason == Reason::end);
}

Behaviour answered(Behaviour before, const PlanAnswer& answer) {
  BehaviourState& state = before.state;
  if (!plan_wanted(state)) return before;
  if (auto* asking = std::get_if<Asking>(&state)) {
    state = with_plan(std::move(*asking), answer, before.places);
  } else if (auto* blocked = std::get_if<Blocked>(&state)) {
    state = with_review(std::move(*blocked), answer);
  } else if (auto* following = std::get_if<Following>(&state)) {
    state = with_review(std::move(*following), answer);
  }
  return before;
}

Behaviour sent_to(Behaviour before, const Vec2& goal_m, std::optional<double> goal_heading_rad,
                  const BehaviourOptions& options) {
  before.places.new_goal();
  Trip trip{RotateThenDrive({}, std::nullopt, options.drive), std::nullopt, false};
  if (trip_in(before.state) != nullptr) trip = moving_trip(std::move(before.state));
  trip.prefers_wide_margins = false;
  trip.goals_beyond = 0;
  trip.wanted =
      PlanRequest{.kind = PlanKind::new_goal, .goal_m = goal_m, .goal_heading_rad = goal_heading_rad};
  before.state = at_rest_asking(std::move(trip));
  return before;
}

Behaviour with_goals_beyond(Behaviour before, std::size_t goals) {
  if (Trip* const trip = trip_in(before.state)) trip->goals_beyond = goals;
  return before;
}

}  // namespace lodestar
