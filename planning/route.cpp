#include "planning/route.hpp"

#include <algorithm>
#include <limits>

#include "maps/segment.hpp"

namespace lodestar {
namespace {

bool is_clear(const Path& path, const MarginPlanner& planner) {
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i) {
    if (!planner.is_clear(path.waypoints_m[i - 1], path.waypoints_m[i])) return false;
  }
  return true;
}

RouteUpdate replaced(const Route& route, const PlanResult& fresh, RouteChange change) {
  if (const auto* failure = std::get_if<PlanFailure>(&fresh)) {
    return {.route = {.path = {}, .goal_heading_rad = route.goal_heading_rad},
            .change = RouteChange::lost,
            .failure = *failure};
  }
  return {.route = {std::get<Plan>(fresh).path, route.goal_heading_rad},
          .change = change,
          .failure = std::nullopt};
}

}  // namespace

std::string_view to_string(RouteChange change) {
  switch (change) {
    case RouteChange::kept:
      return "kept";
    case RouteChange::better:
      return "a better path was found";
    case RouteChange::blocked:
      return "the path was blocked";
    case RouteChange::left_path:
      return "the robot had left the path";
    case RouteChange::extended:
      return "goals were added";
    case RouteChange::more_certain:
      return "planned anew after too long a way without a marker";
    case RouteChange::new_goal:
      return "planned to another goal";
    case RouteChange::lost:
      return "no path any more";
  }
  return "";
}

Path rest_of(const Path& path, const Vec2& position_m) {
  const std::vector<Vec2>& points = path.waypoints_m;
  if (points.size() < 2) return path;
  std::size_t next = 1;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double distance_m = distance_to_segment(points[i - 1], points[i], position_m);
    if (distance_m > least_m) continue;  // a tie, as at a waypoint, goes to the later leg
    least_m = distance_m;
    next = i;
  }
  Path rest{{position_m}};
  rest.waypoints_m.insert(rest.waypoints_m.end(), points.begin() + static_cast<std::ptrdiff_t>(next),
                          points.end());
  return rest;
}

RouteUpdate updated(const Route& route, const Pose2& pose, const MarginPlanner& planner,
                    const RouteOptions& options) {
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = route.goal_heading_rad};
  return updated(route, pose, planner, options,
                 [&] { return planner.plan(pose.position_m, route.path.waypoints_m.back(), headings); });
}

RouteUpdate updated(const Route& route, const Pose2& pose, const MarginPlanner& planner,
                    const RouteOptions& options, const std::function<PlanResult()>& plan_anew) {
  if (route.path.waypoints_m.empty())
    return {.route = route, .change = RouteChange::kept, .failure = std::nullopt};
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = route.goal_heading_rad};
  const PlanResult fresh = plan_anew();
  if (distance_to_path_m(route.path, pose.position_m) > options.left_path_m) {
    return replaced(route, fresh, RouteChange::left_path);
  }
  const Path rest = rest_of(route.path, pose.position_m);
  if (!is_clear(rest, planner)) return replaced(route, fresh, RouteChange::blocked);

  const auto seconds = [&](const Path& path) {
    return travel_time_s(path, headings.start_rad, headings.goal_rad, options.limits);
  };
  const auto* plan = std::get_if<Plan>(&fresh);
  const double worth_s = std::max(options.worth_changing_s, options.worth_changing * seconds(rest));
  if (plan != nullptr && seconds(plan->path) < seconds(rest) - worth_s) {
    return replaced(route, fresh, RouteChange::better);
  }
  return {.route = {rest, route.goal_heading_rad}, .change = RouteChange::kept, .failure = std::nullopt};
}

}  // namespace lodestar
