#include "app/console/path_preview.hpp"

#include "app/console/live_json.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/navigation/trip_planner.hpp"
#include "control/travel_time.hpp"

namespace lodestar {

using nlohmann::ordered_json;

PathPreview::PathPreview(const Site& site, const Places& places)
    : routes_(places, site.robot.max_forward_mps),
      options_(navigation_options(site.robot)),
      planner_(with_keep_out(site.map.map, places.keep_out), options_.planner) {}

ordered_json PathPreview::plan(const Pose2& start, const std::vector<Goal>& goals) const {
  Path whole{{start.position_m}};
  double time_s = 0.0;
  std::size_t turns = 0;
  std::optional<double> heading_rad = start.yaw_rad;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Vec2 from = whole.waypoints_m.back();
    const Goal& goal = goals[i];
    const PlanResult result =
        plan_leg(goal, from, {.start_rad = heading_rad, .goal_rad = goal.heading_rad}, planner_);
    if (const auto* failure = std::get_if<PlanFailure>(&result)) {
      ordered_json refused{{"why", to_string(*failure)}, {"goal", i}, {"nearest", nullptr}};
      const std::optional<Vec2> nearest = planner_.nearest_reachable(from, goal.position_m);
      if (nearest) refused["nearest"] = {nearest->x(), nearest->y()};
      return refused;
    }
    const Path& path = std::get<Plan>(result).path;
    const std::vector<Vec2>& points = path.waypoints_m;
    time_s += ideal_travel_time_s(path, heading_rad, goal.heading_rad, options_.drive);
    turns += points.size() > 2 ? points.size() - 2 : 0;
    whole.waypoints_m.insert(whole.waypoints_m.end(), points.begin() + 1, points.end());
    heading_rad = goal.heading_rad.value_or(heading_between(points[points.size() - 2], points.back()));
  }
  return {
      {"points", points_json(whole)}, {"length_m", length_m(whole)}, {"time_s", time_s}, {"turns", turns}};
}

ordered_json PathPreview::plan_over_edges(const Pose2& start, const std::vector<Goal>& goals) const {
  ordered_json found = plan(start, routes_.over_edges(start.position_m, goals));
  if (!found.contains("why")) return found;
  found["goal"] = goals.size() - 1;  // which of the points on the way it is, says nothing to people
  found["nearest"] = nullptr;
  return found;
}

}  // namespace lodestar
