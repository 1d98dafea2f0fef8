#pragma once

#include <string>
#include <vector>

#include "control/behaviour.hpp"

namespace lodestar {

inline constexpr Duration step_time = std::chrono::milliseconds(20);

/// A state as in the tables of docs/behaviours.md; the robot has seen markers behind it.
struct NamedBehaviour {
  std::string name;
  Behaviour behaviour;
};

/// Findings of a step, or a wish of the operator.
struct NamedFacts {
  std::string name;
  Facts facts;
};

/// On a straight path of 4 m along x, 0.5 m from its beginning.
inline PoseEstimate on_the_way() {
  PoseEstimate estimate;
  estimate.map_from_base = {{0.5, 0.0}, 0.0};
  return estimate;
}

inline Facts calm() {
  Facts facts;
  facts.now = Stamp(std::chrono::seconds(10));
  facts.elapsed = step_time;
  facts.estimate = on_the_way();
  return facts;
}

inline RotateThenDrive drive_at_rest() {
  return RotateThenDrive({{Vec2::Zero(), Vec2(4.0, 0.0)}}, std::nullopt);
}

inline RotateThenDrive rolling_drive() {
  RotateThenDrive drive = drive_at_rest();
  for (int i = 0; i < 60; ++i) drive.update(on_the_way(), step_time);
  return drive;
}

inline RotateThenDrive turning_drive() {
  RotateThenDrive drive = drive_at_rest();
  for (int i = 0; i < 60; ++i) drive.turn_around(SpinOptions{}.turn_radps, step_time);
  return drive;
}

/// Moving back to the beginning of the path, which the robot faces.
inline RotateThenDrive rolling_way_back() {
  PoseEstimate backwards = on_the_way();
  backwards.map_from_base.yaw_rad = radians(180.0);
  RotateThenDrive way({{Vec2(0.5, 0.0), Vec2::Zero()}}, std::nullopt);
  for (int i = 0; i < 20; ++i) way.update(backwards, step_time);
  return way;
}

inline Backtrack places_behind() {
  Backtrack places;
  places.saw_marker_at({-2.0, 0.0});
  places.saw_marker_at(Vec2::Zero());
  return places;
}

inline Backtrack places_when_backtracking() {
  Backtrack places = places_behind();
  places.begin();
  return places;
}

/// A robot in each state of the behaviour.
inline std::vector<NamedBehaviour> all_behaviours() {
  using Reason = Braking::Reason;
  const Trip rolling{rolling_drive(), std::nullopt, false};
  const Trip standing{drive_at_rest(), std::nullopt, false};
  const Trip turning{turning_drive(), std::nullopt, false};
  const Trip nowhere{RotateThenDrive({}, std::nullopt), std::nullopt, false};
  Trip steered = nowhere;
  for (int i = 0; i < 60; ++i) steered.drive.steer({0.2, 0.1}, step_time);
  const auto wanting = [](Trip trip, PlanKind kind) {
    trip.wanted = PlanRequest{.kind = kind, .goal_m = Vec2(2.0, 1.0)};
    return trip;
  };
  const auto uncertain_before = [](Trip trip) {
    trip.prefers_wide_margins = true;
    return trip;
  };
  const auto asking = [&](PlanKind kind) {
    const PlanRequest request{.kind = kind, .goal_m = Vec2(2.0, 1.0)};
    return Asking{kind == PlanKind::way_back ? standing : wanting(standing, kind), request};
  };
  const std::vector<std::pair<std::string, BehaviourState>> states{
      {"Standing", Standing{}},
      {"Arrived", Arrived{}},
      {"Following", Following{rolling}},
      {"Blocked", Blocked{standing, false}},
      {"Braking: stop", Braking{rolling, Reason::stop}},
      {"Braking: uncertain, rolling", Braking{rolling, Reason::uncertain}},
      {"Braking: uncertain, at rest", Braking{standing, Reason::uncertain}},
      {"the same, not the first time", Braking{uncertain_before(standing), Reason::uncertain}},
      {"Braking: replan, rolling", Braking{wanting(rolling, PlanKind::replan), Reason::replan}},
      {"Braking: replan, at rest", Braking{wanting(standing, PlanKind::replan), Reason::replan}},
      {"Braking: marker found, rolling",
       Braking{wanting(rolling, PlanKind::another_way), Reason::marker_found}},
      {"Braking: marker found, at rest",
       Braking{wanting(standing, PlanKind::another_way), Reason::marker_found}},
      {"Braking: end", Braking{rolling, Reason::end}},
      {"Searching", Searching{turning, Spin()}},
      {"Searching, no goal yet", Searching{nowhere, Spin()}},
      {"Asking: replan", asking(PlanKind::replan)},
      {"Asking: another way", asking(PlanKind::another_way)},
      {"Asking: new goal", asking(PlanKind::new_goal)},
      {"Asking: way back", asking(PlanKind::way_back)},
      {"Backtracking", Backtracking{wanting(standing, PlanKind::another_way), rolling_way_back()}},
      {"Paused", Paused{rolling, std::nullopt}},
      {"Paused, backtracking", Paused{wanting(standing, PlanKind::another_way), rolling_way_back()}},
      {"Steered", Steered{steered}}};
  std::vector<NamedBehaviour> behaviours;
  behaviours.reserve(states.size());
  for (const auto& [name, state] : states) {
    const bool goes_back =
        name.find("acktracking") != std::string::npos || name.find("found") != std::string::npos;
    behaviours.push_back({name, {state, goes_back ? places_when_backtracking() : places_behind()}});
  }
  return behaviours;
}

/// One finding at a time.
inline std::vector<NamedFacts> all_findings() {
  const auto with = [](const auto& change) {
    Facts facts = calm();
    facts.may_look_around = true;
    change(facts);
    return facts;
  };
  return {{"nothing new", with([](Facts&) {})},
          {"too little clearance for its uncertainty",
           with([](Facts& f) { f.room_ahead = RoomAhead::too_little_when_uncertain; })},
          {"too uncertain", with([](Facts& f) { f.stop = StopReason::pose_uncertain; })},
          {"too uncertain even to backtrack",
           with([](Facts& f) { f.stop = f.stop_on_backtrack = StopReason::pose_uncertain; })},
          {"camera lost", with([](Facts& f) { f.stop = f.stop_on_backtrack = StopReason::camera_silent; })},
          {"carried away", with([](Facts& f) { f.stop = f.stop_on_backtrack = StopReason::carried_away; })},
          {"marker seen", with([](Facts& f) { f.sees_marker = true; })},
          {"off its path", with([](Facts& f) { f.estimate->map_from_base.position_m.y() = 0.5; })}};
}

inline std::vector<NamedFacts> all_wishes() {
  const auto with = [](const auto& change) {
    Facts facts = calm();
    change(facts);
    return facts;
  };
  return {{"pause", with([](Facts& f) { f.wish = Wish::pause; })},
          {"go on", with([](Facts&) {})},
          {"cancel", with([](Facts& f) { f.wish = Wish::cancel; })},
          {"halt", with([](Facts& f) { f.wish = Wish::halt; })},
          {"steer", with([](Facts& f) { f.steering = BodyVelocity{0.2, 0.1}; })},
          {"steer without a pose", with([](Facts& f) {
             f.steering = BodyVelocity{0.2, 0.1};
             f.stop = f.stop_on_backtrack = StopReason::no_pose;
           })},
          {"steer while the base is silent", with([](Facts& f) {
             f.steering = BodyVelocity{0.2, 0.1};
             f.stop = f.stop_on_backtrack = StopReason::base_silent;
           })},
          {"changed map", with([](Facts& f) { f.map_changed = true; })}};
}

}  // namespace lodestar
