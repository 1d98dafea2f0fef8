#pragma once

#include <optional>

#include "planning/margin_planner.hpp"

namespace lodestar {

struct RouteOptions {
  double worth_changing =
      0.1;  ///< a new path must save this share of the time that the present one still takes
  double worth_changing_s = 1.0;  ///< and at least so much; else the robot would waver between equals
  double left_path_m = 0.2;       ///< farther from the path, the robot is no longer on it
  MotionLimits limits;
};

/// What became of the path.
enum class RouteChange {
  kept,          ///< still clear, nothing clearly better
  better,        ///< a clearly faster one was found
  blocked,       ///< something stands in its way; replaced
  left_path,     ///< the robot is not on it; replaced
  more_certain,  ///< it led too far without a marker; planned anew
  new_goal,      ///< the first to another goal; where there is none, failure says why
  lost           ///< it cannot be followed and there is no other: failure says why
};
std::string_view to_string(RouteChange change);

/// A path being followed to a goal, with the final heading if one is wanted. A value: an update gives a new
/// one.
struct Route {
  Path path;
  std::optional<double> goal_heading_rad;
};

struct RouteUpdate {
  Route route;  ///< from where the robot is; empty when lost
  RouteChange change = RouteChange::kept;
  std::optional<PlanFailure> failure;
};

/// What is left of a path for a robot at this place: straight to the end of the nearest leg, and on.
Path rest_of(const Path& path, const Vec2& position_m);

/// Looks at the route again with a planner that knows the map as it is now. The route is kept unless it
/// cannot be or another is clearly better; a kept route's waypoints do not change, apart from those passed.
RouteUpdate updated(const Route& route, const Pose2& pose, const MarginPlanner& planner,
                    const RouteOptions& options = {});

}  // namespace lodestar
