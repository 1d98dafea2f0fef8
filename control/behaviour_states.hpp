#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "control/rotate_then_drive.hpp"
#include "control/spin.hpp"

// The robot's behaviour as a state machine. Exactly one of these states holds; docs/behaviours.md has the
// transition table.
namespace lodestar {

/// Purpose of a plan, in rising urgency.
enum class PlanKind {
  extension,    ///< on from the path's end to goals that were added. Asked while driving
  review,       ///< is the path still clear, and no other clearly faster? Asked while driving
  replan,       ///< after a failed review: a path to the same goal, unless the old one is valid after all
  another_way,  ///< with wider margins, and away from where no marker was found
  new_goal,     ///< to another goal
  way_back      ///< backtrack to where a marker was seen last
};

/// A request for a plan. The answer may take several steps.
struct PlanRequest {
  PlanKind kind = PlanKind::review;
  Vec2 goal_m = Vec2::Zero();              ///< in the map; of new_goal and way_back
  std::optional<double> goal_heading_rad;  ///< of new_goal
  /// An obstacle is right ahead: the present leg starts at the robot's position.
  bool leg_from_here = false;

  bool operator==(const PlanRequest&) const = default;
};

/// A trip to a goal; without one when the path is empty and no plan is wanted.
struct Trip {
  RotateThenDrive drive;              ///< moves the robot along the path, to rest, or on the spot
  std::optional<PlanRequest> wanted;  ///< a plan needed before the robot goes on; a review can wait
  bool prefers_wide_margins = false;  ///< the pose was too uncertain once on the way to this goal
  std::size_t goals_beyond = 0;       ///< goals that were added, to which the path does not lead yet
};

/// Follows no path.
struct Standing {};

/// Has reached the end of its path, and follows none.
struct Arrived {};

/// Drives along its path.
struct Following {
  Trip trip;
};

/// Faces along its path and waits for clearance ahead.
struct Blocked {
  Trip trip;
  bool only_by_uncertainty = false;  ///< lacks clearance only for its safety margin, and cannot backtrack
};

/// Brakes to rest, and stays there until the reason is gone.
struct Braking {
  enum class Reason {
    stop,          ///< must not move, and a marker in view would not change that
    uncertain,     ///< pose too uncertain to go on: at rest asks for wider margins, or backtracks
    replan,        ///< the path is to be replaced: at rest asks for another
    marker_found,  ///< while backtracking: can go on from here
    end            ///< the trip ends
  };
  Trip trip;
  Reason reason = Reason::stop;
};

/// Pose lost, and backtracking is not possible: brakes to rest, waits, and spins once to look for a marker.
/// Also without a path.
struct Searching {
  Trip trip;
  Spin look;
};

/// Stands until a plan arrives.
struct Asking {
  Trip trip;
  PlanRequest request;
};

/// Backtracks to where it saw a marker.
struct Backtracking {
  Trip trip;            ///< resumed afterwards
  RotateThenDrive way;  ///< moves the robot back
};

/// Brakes to rest and stays there until the operator resumes.
struct Paused {
  Trip trip;
  std::optional<RotateThenDrive> way_back;  ///< when it was backtracking
};

/// Moves as the operator steers, with a trip that has no path.
struct Steered {
  Trip trip;
};

using BehaviourState = std::variant<Standing, Arrived, Following, Blocked, Braking, Searching, Asking,
                                    Backtracking, Paused, Steered>;

/// The name in docs/behaviours.md: "Following", "Braking: unsure", "Asking: way back".
std::string_view to_string(const BehaviourState& state);

}  // namespace lodestar
