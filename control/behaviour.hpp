#pragma once

#include <optional>
#include <variant>

#include "control/backtrack.hpp"
#include "control/behaviour_states.hpp"
#include "control/safety_stop.hpp"
#include "control/speed_limit.hpp"

namespace lodestar {

/// What the operator wants of the trip under way.
enum class Wish {
  go_on,
  pause,   ///< come to rest, and go on later
  cancel,  ///< come to rest, and follow nothing any more
  halt     ///< follow nothing any more, and command zero at once
};

/// Is there room straight ahead, for the disc of the robot and what it does not know of its place?
enum class RoomAhead {
  enough,
  too_little_when_uncertain,  ///< were it sure of its place there would be
  none
};

/// All that a step has to decide by. Times and travel come with the data.
struct Facts {
  Stamp now;
  Duration elapsed = Duration::zero();  ///< since the last step
  double turned_rad = 0.0;              ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate;
  bool sees_marker = false;                     ///< one that agrees with the estimate, in this step
  std::optional<StopReason> stop;               ///< why it must not move
  std::optional<StopReason> stop_on_backtrack;  ///< why not even back by the way that it has just come
  SpeedLimit limit;                             ///< valid while there is no `stop`
  RoomAhead room_ahead = RoomAhead::enough;     ///< likewise
  SpeedLimit limit_on_backtrack;                ///< valid while there is no `stop_on_backtrack`
  Wish wish = Wish::go_on;
  bool may_look_around = false;  ///< while it follows nothing
  bool map_changed = false;      ///< since the last step
};

struct BehaviourOptions {
  DriveOptions drive;
  SpinOptions spin;
  BacktrackOptions backtrack;
  double left_path_m = 0.2;  ///< farther from its path, the robot is no longer on it
};

/// What the robot is about, and the places that it remembers. A value.
struct Behaviour {
  BehaviourState state;
  Backtrack places;
};

/// The states in which a step leads to another before the robot moves: what it wants to do about the facts.
Behaviour decided(Behaviour before, const Facts& facts, const BehaviourOptions& options);

/// The plan that it waits for, or wants while it drives: then it is on a trip.
std::optional<PlanRequest> plan_wanted(const BehaviourState& state);

/// Nothing while it follows nothing.
const Trip* trip_of(const BehaviourState& state);

/// Is it on a trip that leads somewhere, and has not been ended?
bool is_under_way(const BehaviourState& state);

/// What may come of a request.
struct PathStaysValid {};      ///< the old path does
struct PathMustBeReplaced {};  ///< of a review: it is to be replaced
struct PathNotFound {};        ///< none, or no other
struct PathFound {
  RotateThenDrive drive;
};
using PlanAnswer = std::variant<PathStaysValid, PathMustBeReplaced, PathNotFound, PathFound>;

/// Takes the answer to the plan that was wanted.
Behaviour answered(Behaviour before, const PlanAnswer& answer);

/// To another goal: asks for a plan at once if it stands, else when it has come to rest.
Behaviour sent_to(Behaviour before, const Vec2& goal_m, std::optional<double> goal_heading_rad,
                  const BehaviourOptions& options);

struct Moved {
  BodyVelocity command;
  Behaviour behaviour;  ///< after it: the robot may have arrived, come to rest, or found no room
};

/// Commands what the state demands.
Moved moved(Behaviour before, const Facts& facts, const BehaviourOptions& options);

/// What people are told of a step: why the robot may not go on, and whether it goes back.
struct Shown {
  std::optional<StopReason> stop;
  bool backtracks = false;
};
Shown shown(const Behaviour& decided, const Behaviour& moved, const Facts& facts);

/// Why it must not move: what the facts say, or that it went back and saw no marker even there.
std::optional<StopReason> reason_to_stay(const Facts& facts, const Backtrack& places);

/// May it leave the path and go back to where it saw a marker?
bool can_go_back(const Facts& facts, const Backtrack& places);

}  // namespace lodestar
