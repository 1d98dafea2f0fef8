#pragma once

#include <optional>
#include <variant>

#include "control/backtrack.hpp"
#include "control/behaviour_states.hpp"
#include "control/safety_stop.hpp"
#include "control/speed_limit.hpp"
#include "control/steering.hpp"

namespace lodestar {

/// The operator's command for the trip under way.
enum class Wish {
  go_on,
  pause,   ///< brake to rest, and go on later
  cancel,  ///< brake to rest, and drop the path
  halt     ///< drop the path, and command zero at once
};

/// Is there clearance straight ahead for the robot's disc plus its safety margin for pose uncertainty?
enum class RoomAhead {
  enough,
  too_little_when_uncertain,  ///< enough for the disc without the margin
  none
};

/// All inputs of a step's decision. Times and travel come with the data.
struct Facts {
  Stamp now;
  Duration elapsed = Duration::zero();  ///< since the last step
  double turned_rad = 0.0;              ///< by the wheels, since start-up
  std::optional<PoseEstimate> estimate;
  bool sees_marker = false;                     ///< one that agrees with the estimate, in this step
  std::optional<StopReason> stop;               ///< why the robot must not move
  std::optional<StopReason> stop_on_backtrack;  ///< why it must not even backtrack
  SpeedLimit limit;                             ///< valid while there is no `stop`
  RoomAhead room_ahead = RoomAhead::enough;     ///< likewise
  SpeedLimit limit_on_backtrack;                ///< valid while there is no `stop_on_backtrack`
  Wish wish = Wish::go_on;
  std::optional<BodyVelocity> steering;  ///< by the operator's hand, as ordered just now
  bool may_look_around = false;          ///< may spin while it follows no path
  bool map_changed = false;              ///< since the last step
};

struct BehaviourOptions {
  DriveOptions drive;
  SpinOptions spin;
  BacktrackOptions backtrack;
  SteeringOptions steering;
  double left_path_m = 0.2;  ///< greatest distance from the path at which the robot counts as on it
};

/// The state, and the positions remembered for backtracking. A value.
struct Behaviour {
  BehaviourState state;
  Backtrack places;
};

/// The state after the transitions that the facts demand, before the robot moves.
Behaviour decided(Behaviour before, const Facts& facts, const BehaviourOptions& options);

/// The plan that the robot waits for, or wants while it drives; then trip_of() is not null.
std::optional<PlanRequest> plan_wanted(const BehaviourState& state);

/// Null in Standing and Arrived.
const Trip* trip_of(const BehaviourState& state);

/// Is the robot on a trip with a path or a wanted plan, and not braking to end it?
bool is_under_way(const BehaviourState& state);

/// Answers to a plan request.
struct PathStaysValid {};      ///< the old path is kept
struct PathMustBeReplaced {};  ///< only of a review
struct PathNotFound {};        ///< no path, or no other one
struct PathFound {
  RotateThenDrive drive;
};
struct PathExtended {  ///< only of an extension: from the path's end on
  Path tail;
  bool passes_end = false;  ///< that end is so straight on the way that the robot drives past it
  std::optional<double> final_heading_rad;
  double blend_corridor_m = 0.0;
};
using PlanAnswer = std::variant<PathStaysValid, PathMustBeReplaced, PathNotFound, PathFound, PathExtended>;

/// Applies the answer to the wanted plan.
Behaviour answered(Behaviour before, const PlanAnswer& answer);

/// Starts a trip to another goal: asks for a plan at once when at rest, else after braking to rest.
Behaviour sent_to(Behaviour before, const Vec2& goal_m, std::optional<double> goal_heading_rad,
                  const BehaviourOptions& options);

/// So many goals lie beyond the end of the trip's path: asks for the way on, without braking.
Behaviour with_goals_beyond(Behaviour before, std::size_t goals);

struct Moved {
  BodyVelocity command;
  Behaviour behaviour;  ///< after the command: arrived, at rest, blocked, or unchanged
};

/// The command of the state, and the state after it.
Moved moved(Behaviour before, const Facts& facts, const BehaviourOptions& options);

/// After another velocity was sent than the state's command: the state's drive goes on from there.
Behaviour after_sending(Behaviour moved, const BodyVelocity& sent, Duration elapsed);

/// A step's report to the operator: why the robot stops, and whether it backtracks.
struct Shown {
  std::optional<StopReason> stop;
  bool backtracks = false;
};
Shown shown(const Behaviour& decided, const Behaviour& moved, const Facts& facts);

/// Why the robot must not move: the facts' stop, or pose_stale after a backtrack that found no marker.
std::optional<StopReason> reason_to_stay(const Facts& facts, const Backtrack& places);

/// May the robot leave the path and backtrack to a marker?
bool can_go_back(const Facts& facts, const Backtrack& places);

}  // namespace lodestar
