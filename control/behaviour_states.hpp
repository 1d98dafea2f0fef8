#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "control/rotate_then_drive.hpp"
#include "control/spin.hpp"

// What the robot can be about. Exactly one of these states holds; docs/behaviours.md has the table of what
// leads from one to another.
namespace lodestar {

/// What a plan can be wanted for, the more urgent later.
enum class PlanKind {
  review,       ///< is the path still clear, and no other clearly faster? Asked for while driving
  replan,       ///< it is not: a path from here to the same goal, unless the old one holds after all
  another_way,  ///< with more room, and away from ground where no marker was found
  new_goal,     ///< to another goal
  way_back      ///< to where a marker was seen last
};

/// A request for a plan. It may take several steps to be answered.
struct PlanRequest {
  PlanKind kind = PlanKind::review;
  Vec2 goal_m = Vec2::Zero();              ///< in the map; of new_goal and way_back
  std::optional<double> goal_heading_rad;  ///< of new_goal
  /// Something stands in the way right here: the present leg counts from where the robot is.
  bool leg_from_here = false;
};

/// On the way to a goal, or, with an empty path and no plan wanted, to none.
struct Trip {
  RotateThenDrive drive;              ///< what moves the robot along the path, or to rest, or around
  std::optional<PlanRequest> wanted;  ///< a plan that it needs before it goes on; a review can wait
  bool prefers_wide_margins = false;  ///< has been too unsure on the way to this goal
};

/// Follows nothing.
struct Standing {};

/// Has come to the end of its path, and follows nothing any more.
struct Arrived {};

/// Drives along its path.
struct Following {
  Trip trip;
};

/// Is on its path, turned along it, and has no room to go on: it waits until it has.
struct Blocked {
  Trip trip;
  bool only_by_uncertainty = false;  ///< were it sure of its place it would have room; and it cannot go back
};

/// Comes to rest, and stays there until what it brakes for is over.
struct Braking {
  enum class Reason {
    stop,          ///< it must not move, and no marker would change that
    uncertain,     ///< of its place, too much to go on: at rest it looks for a surer way, or goes back
    replan,        ///< its path is to be replaced: at rest it asks for another
    marker_found,  ///< on its way back: from here it can go on
    end            ///< it follows nothing any more
  };
  Trip trip;
  Reason reason = Reason::stop;
};

/// Does not know where it is, and may not or cannot go back: comes to rest, waits, and turns around once to
/// look for a marker. Also while it follows nothing.
struct Searching {
  Trip trip;
  Spin look;
};

/// Stands until it is given a plan.
struct Asking {
  Trip trip;
  PlanRequest request;
};

/// Goes back to where it saw a marker.
struct Backtracking {
  Trip trip;            ///< to be taken up again
  RotateThenDrive way;  ///< moves the robot
};

/// Comes to rest and stays there as the operator wishes.
struct Paused {
  Trip trip;
  std::optional<RotateThenDrive> way_back;  ///< it was backtracking
};

using BehaviourState =
    std::variant<Standing, Arrived, Following, Blocked, Braking, Searching, Asking, Backtracking, Paused>;

/// As docs/behaviours.md calls it: "Following", "Braking: uncertain", "Asking: way back".
std::string_view to_string(const BehaviourState& state);

}  // namespace lodestar
