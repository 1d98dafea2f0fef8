#pragma once

#include <functional>
#include <optional>

#include "planning/margin_planner.hpp"

namespace lodestar {

struct RouteOptions {
  double worth_changing = 0.1;    ///< a new path must save this share of the remaining travel time
  double worth_changing_s = 1.0;  ///< and at least this much, so that the robot does not waver
  double left_path_m = 0.2;       ///< greatest distance from the path at which the robot counts as on it
  MotionLimits limits;
};

/// Result of a route update.
enum class RouteChange {
  kept,          ///< still clear, and no other path clearly faster
  better,        ///< replaced by a clearly faster path
  blocked,       ///< replaced, as an obstacle blocks it
  left_path,     ///< replaced, as the robot has left it
  extended,      ///< goes on to goals that were added
  more_certain,  ///< replaced, as the pose became too uncertain on it
  new_goal,      ///< first path to another goal; without one, failure says why
  lost           ///< cannot be followed and there is no other: failure says why
};
std::string_view to_string(RouteChange change);

/// A path being followed to a goal, with the final heading if one is wanted. A value type.
struct Route {
  Path path;
  std::optional<double> goal_heading_rad;
};

struct RouteUpdate {
  Route route;  ///< from the robot's position; empty when lost
  RouteChange change = RouteChange::kept;
  std::optional<PlanFailure> failure;
};

/// The rest of a path from this position: straight to the end of the nearest leg, and on.
Path rest_of(const Path& path, const Vec2& position_m);

/// Reviews the route with a planner for the present map. Keeps it unless it is blocked, left by the robot, or
/// clearly slower than another. A kept route starts at the robot and keeps the waypoints ahead.
RouteUpdate updated(const Route& route, const Pose2& pose, const MarginPlanner& planner,
                    const RouteOptions& options = {});

/// The same for a route that leads over more than its end: `plan_anew` plans over all that is to come.
RouteUpdate updated(const Route& route, const Pose2& pose, const MarginPlanner& planner,
                    const RouteOptions& options, const std::function<PlanResult()>& plan_anew);

}  // namespace lodestar
