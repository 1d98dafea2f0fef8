#include "app/navigation/trip_planner.hpp"

#include <utility>

#include "maps/map_overlay.hpp"

namespace lodestar {

TripPlanner::TripPlanner(std::shared_ptr<const ObstacleField> field, const TripPlannerOptions& options)
    : options_(options) {
  use_map(std::move(field), {}, {});
}

void TripPlanner::use_map(std::shared_ptr<const ObstacleField> map, std::span<const Vec2> obstacles_in_map,
                          std::span<const Vec2> blind_m) {
  map_ = std::move(map);
  obstacles_in_map_.assign(obstacles_in_map.begin(), obstacles_in_map.end());
  plan_around(blind_m);
}

void TripPlanner::plan_around(std::span<const Vec2> blind_m) {
  map_alone_.reset();
  if (obstacles_in_map_.empty()) {
    context_.emplace(context_on(map_, blind_m));
    return;
  }
  map_alone_.emplace(context_on(map_, blind_m));
  context_.emplace(
      context_on(std::make_shared<const ObstacleField>(overlaid(map_->map(), obstacles_in_map_)), blind_m));
}

/// After the pose was too uncertain, or with blind places, margins are wide. Where no marker was found, the
/// robot drives again only if every other path is far longer.
PlanningContext TripPlanner::context_on(std::shared_ptr<const ObstacleField> field,
                                        std::span<const Vec2> blind_m) const {
  GridPlannerOptions options = options_.planner;
  options.avoided.places_m.assign(blind_m.begin(), blind_m.end());
  const bool is_unsure = prefers_wide_margins_ || !blind_m.empty();
  return {std::move(field), options, is_unsure ? Margins::wide : Margins::usual};
}

TripPlan TripPlanner::plan(const TripQuery& query) {
  const auto& [request, trip, pose, blind_m] = query;
  const bool needs_other_context = trip.prefers_wide_margins != prefers_wide_margins_;
  const bool begins_anew = request.kind == PlanKind::new_goal && needs_other_context;
  if (begins_anew || request.kind == PlanKind::another_way) {
    prefers_wide_margins_ = trip.prefers_wide_margins;
    plan_around(blind_m);
  }
  switch (request.kind) {
    case PlanKind::review:
      // Sampling planners are too slow to run while the robot drives: it brakes and replans at rest.
      if (sampling_method(options_.planner.kind)) return {PathMustBeReplaced{}, std::nullopt};
      return review(route_from(request, trip, pose));
    case PlanKind::replan:
      return replan(route_from(request, trip, pose));
    case PlanKind::another_way:
      return another_way(trip, pose);
    case PlanKind::new_goal:
      return to_goal(request, pose);
    case PlanKind::way_back:
      break;
  }
  return way_back(request.goal_m, trip, pose);
}

TripPlan TripPlanner::review(const RouteUpdate& update) const {
  if (update.change == RouteChange::kept) return {PathStaysValid{}, std::nullopt};
  return {PathMustBeReplaced{}, std::nullopt};
}

TripPlan TripPlanner::replan(const RouteUpdate& update) const {
  if (update.change == RouteChange::kept) return {PathStaysValid{}, std::nullopt};
  if (update.change == RouteChange::lost) return {PathNotFound{}, update};
  return {along(update.route), update};
}

TripPlan TripPlanner::another_way(const Trip& trip, const Pose2& pose) const {
  const std::optional<double>& goal_heading_rad = trip.drive.final_heading_rad();
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = goal_heading_rad};
  const Vec2 goal_m = trip.drive.path_ahead().waypoints_m.back();
  const PlanResult result = context_->planner.plan(pose.position_m, goal_m, headings);
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return {PathNotFound{}, std::nullopt};
  const Route route{plan->path, goal_heading_rad};
  return {along(route),
          RouteUpdate{.route = route, .change = RouteChange::more_certain, .failure = std::nullopt}};
}

TripPlan TripPlanner::to_goal(const PlanRequest& request, const Pose2& pose) const {
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = request.goal_heading_rad};
  PlanResult result = context_->planner.plan(pose.position_m, request.goal_m, headings);
  if (map_alone_ && std::holds_alternative<PlanFailure>(result))
    result = map_alone_->planner.plan(pose.position_m, request.goal_m, headings);
  RouteUpdate update{.route = {{}, request.goal_heading_rad}, .change = RouteChange::new_goal, .failure = {}};
  if (const auto* failure = std::get_if<PlanFailure>(&result)) {
    update.failure = *failure;
    return {PathNotFound{}, update};
  }
  update.route.path = std::get<Plan>(result).path;
  return {along(update.route), update};
}

/// Goes back along the present leg first: every other way may be narrower.
TripPlan TripPlanner::way_back(const Vec2& place_m, const Trip& trip, const Pose2& pose) const {
  constexpr double beside_leg_m = 0.3;
  const auto along_way = [&](Path path) {
    return TripPlan{PathFound{RotateThenDrive(std::move(path), std::nullopt, options_.drive)}, std::nullopt};
  };
  const std::vector<Vec2> ahead_m = trip.drive.path_ahead().waypoints_m;
  const bool is_on_leg =
      ahead_m.size() > 1 && distance_to_path_m({{ahead_m[0], ahead_m[1]}}, pose.position_m) <= beside_leg_m;
  const Vec2 from_m = is_on_leg ? ahead_m.front() : pose.position_m;
  if (distance_to_path_m({{from_m, pose.position_m}}, place_m) <= beside_leg_m)
    return along_way({{pose.position_m, place_m}});
  const MarginPlanner planner(context_->field, options_.planner, margins_m(Margins::wide));
  const PlanResult result = planner.plan(from_m, place_m);
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return {PathNotFound{}, std::nullopt};
  Path path = plan->path;
  if (is_on_leg) path.waypoints_m.insert(path.waypoints_m.begin(), pose.position_m);
  return along_way(std::move(path));
}

RouteUpdate TripPlanner::route_from(const PlanRequest& request, const Trip& trip, const Pose2& pose) const {
  Route route{trip.drive.path_ahead(), trip.drive.final_heading_rad()};
  if (request.leg_from_here) route.path.waypoints_m.front() = pose.position_m;
  RouteUpdate update = updated(route, pose, context_->planner, options_.route);
  if (map_alone_ && update.failure) update = updated(route, pose, map_alone_->planner, options_.route);
  return update;
}

PathFound TripPlanner::along(const Route& route) const {
  const DriveOptions drive = context_->drive_options(route.path, options_.drive);
  return {RotateThenDrive(route.path, route.goal_heading_rad, drive)};
}

}  // namespace lodestar
