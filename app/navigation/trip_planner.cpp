#include "app/navigation/trip_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "maps/map_overlay.hpp"
#include "maps/motion.hpp"

namespace lodestar {
namespace {

std::optional<double> end_heading(const Goal& goal) {
  return goal.passes ? std::nullopt : goal.heading_rad;
}

/// Those of the trip, the last where the path ends, maybe beside an obstacle that it touches; or the one that
/// the request or the trip's path has.
std::vector<Goal> goals_of(const TripQuery& query) {
  const std::vector<Vec2> path_m = query.trip.drive.path_ahead().waypoints_m;
  if (!query.goals.empty()) {
    std::vector<Goal> goals = query.goals;
    const bool has_way = query.request.kind != PlanKind::new_goal && query.trip.goals_beyond == 0;
    if (has_way && !path_m.empty()) goals.back().position_m = path_m.back();
    return goals;
  }
  if (query.request.kind == PlanKind::new_goal)
    return {{.position_m = query.request.goal_m, .heading_rad = query.request.goal_heading_rad}};
  return {{.position_m = path_m.back(), .heading_rad = query.trip.drive.final_heading_rad()}};
}

std::optional<double> final_heading(const TripQuery& query) {
  return end_heading(goals_of(query).back());
}

/// Are the points between its ends so near to the straight line between these, and is it clear, that the
/// robot need neither stop nor turn there? Twice as far as it may be from a goal at which it arrives.
bool is_straight(std::span<const Vec2> points_m, const MarginPlanner& planner) {
  constexpr double beside_m = 0.02;
  const Path line{{points_m.front(), points_m.back()}};
  const auto is_near = [&](const Vec2& point_m) { return distance_to_path_m(line, point_m) <= beside_m; };
  return std::ranges::all_of(points_m, is_near) && planner.is_clear(points_m.front(), points_m.back());
}

/// Without the waypoints that are straight on.
Path straightened(const Path& path, const MarginPlanner& planner) {
  const std::span<const Vec2> points_m = path.waypoints_m;
  Path few{{points_m.front()}};
  for (std::size_t from = 0; from + 1 < points_m.size();) {
    std::size_t to = from + 1;
    while (to + 1 < points_m.size() && is_straight(points_m.subspan(from, to + 2 - from), planner)) ++to;
    few.waypoints_m.push_back(points_m[to]);
    from = to;
  }
  return few;
}

/// Null where there is none.
const Path* way_of(const PlanResult& result) {
  const auto* plan = std::get_if<Plan>(&result);
  return plan == nullptr ? nullptr : &plan->path;
}
const Path* way_of(const RouteUpdate& update) {
  return update.failure ? nullptr : &update.route.path;
}

/// A way with room around the obstacles may be longer than one close by them. Chosen by hand.
struct LongestDetour {
  double share = 0.0;
  double more_m = 0.0;
};
/// Close by them the robot creeps, as the protective field has it, and what was seen badly may block it
/// still.
constexpr LongestDetour to_pass_with_room{.share = 1.5, .more_m = 1.0};
/// What can be passed already is left for a step aside. From nearer another way may have no more room: a
/// robot that turned for it would go to and fro.
constexpr LongestDetour to_leave_a_way{.share = 1.1, .more_m = 0.3};

bool is_too_long(double length_m, double other_m, const LongestDetour& longest) {
  return length_m > longest.share * other_m + longest.more_m;
}

double straight_m(const Path& way) {
  return way.waypoints_m.empty() ? 0.0 : (way.waypoints_m.back() - way.waypoints_m.front()).norm();
}

/// One path over all goals in turn. Each leg begins with the heading in which the one before ends.
PlanResult plan_over(std::span<const Goal> goals, const Pose2& start,
                     const std::optional<double>& final_heading_rad, const MarginPlanner& planner) {
  PlanResult all = PlanFailure::no_path;
  PlanHeadings headings{.start_rad = start.yaw_rad, .goal_rad = std::nullopt};
  Vec2 from_m = start.position_m;
  for (const Goal& goal : goals) {
    if (&goal == &goals.back()) headings.goal_rad = final_heading_rad;
    PlanResult leg = plan_leg(goal, from_m, headings, planner);
    if (way_of(leg) == nullptr) return leg;
    if (goals.size() == 1) return leg;
    const std::vector<Vec2>& more_m = std::get<Plan>(leg).path.waypoints_m;
    from_m = more_m.back();
    if (more_m.size() > 1) headings.start_rad = heading_between(more_m[more_m.size() - 2], from_m);
    if (auto* plan = std::get_if<Plan>(&all)) {
      plan->path.waypoints_m.insert(plan->path.waypoints_m.end(), more_m.begin() + 1, more_m.end());
    } else {
      all = std::move(leg);
    }
  }
  if (auto* plan = std::get_if<Plan>(&all)) plan->path = straightened(plan->path, planner);
  return all;
}

}  // namespace

PlanResult plan_leg(const Goal& goal, const Vec2& from_m, const PlanHeadings& headings,
                    const MarginPlanner& planner) {
  if (!goal.on_line) return planner.plan(from_m, goal.position_m, headings);
  if (!planner.is_clear(from_m, goal.position_m)) return PlanFailure::line_blocked;
  Plan straight;
  straight.path = {{from_m, goal.position_m}};
  return straight;
}

TripPlanner::TripPlanner(std::shared_ptr<const ObstacleField> field, const TripPlannerOptions& options)
    : options_(options) {
  use_map(std::move(field), {}, {});
}

void TripPlanner::use_map(std::shared_ptr<const ObstacleField> map, UnmappedObstacles obstacles,
                          std::span<const Vec2> blind_m) {
  map_ = std::move(map);
  obstacles_ = std::move(obstacles);
  plan_around(blind_m);
}

void TripPlanner::plan_around(std::span<const Vec2> blind_m) {
  blind_m_.assign(blind_m.begin(), blind_m.end());
  tight_.reset();
  bare_.reset();
  map_alone_.reset();
  context_.emplace(context_around(obstacles_.roomy_m));
}

PlanningContext TripPlanner::context_around(std::span<const Vec2> obstacles_m) const {
  if (obstacles_m.empty()) return context_on(map_);
  OccupancyMap map = overlaid(split(map_->map(), parts_of_a_cell()), obstacles_m);
  return context_on(std::make_shared<const ObstacleField>(std::move(map)));
}

/// A side of a cell of the map, where obstacles are planned around.
int TripPlanner::parts_of_a_cell() const {
  constexpr double rounding = 1e-6;
  const OccupancyMap& map = map_->map();
  const double parts = std::ceil(map.resolution_m / options_.obstacle_cell_m - rounding);
  const double most =
      std::sqrt(static_cast<double>(options_.most_obstacle_cells) / static_cast<double>(map.cells.size()));
  return std::max(1, static_cast<int>(std::min(parts, most)));
}

const MarginPlanner& TripPlanner::tight_planner() {
  if (!tight_) tight_.emplace(context_around(obstacles_.tight_m));
  return tight_->planner;
}

/// What `plan` finds with room around the obstacles; close to them, where that is a long detour or none; else
/// with no room, or without them.
template <typename Plan>
auto TripPlanner::first_of(const Plan& plan) {
  auto roomy = plan(context_->planner);
  const Path* const roomy_way = way_of(roomy);
  if (obstacles_.empty()) return roomy;
  if (roomy_way && !is_too_long(length_m(*roomy_way), straight_m(*roomy_way), to_pass_with_room))
    return roomy;
  auto tight = plan(tight_planner());
  const Path* const tight_way = way_of(tight);
  if (tight_way && (!roomy_way || is_too_long(length_m(*roomy_way), length_m(*tight_way), to_pass_with_room)))
    return tight;
  if (roomy_way) return roomy;
  if (!bare_) bare_.emplace(context_around(obstacles_.bare_m));
  auto bare = plan(bare_->planner);
  if (way_of(bare)) return bare;
  if (!map_alone_) map_alone_.emplace(context_on(map_));
  return plan(map_alone_->planner);
}

/// After the pose was too uncertain, or with blind places, margins are wide. Where no marker was found, the
/// robot drives again only if every other path is far longer.
PlanningContext TripPlanner::context_on(std::shared_ptr<const ObstacleField> field) const {
  GridPlannerOptions options = options_.planner;
  options.avoided.places_m = blind_m_;
  const bool is_unsure = prefers_wide_margins_ || !blind_m_.empty();
  return {std::move(field), options, is_unsure ? Margins::wide : Margins::usual};
}

TripPlan TripPlanner::plan(const TripQuery& query) {
  const auto& [request, trip, pose, blind_m, goals] = query;
  const bool needs_other_context = trip.prefers_wide_margins != prefers_wide_margins_;
  const bool begins_anew = request.kind == PlanKind::new_goal && needs_other_context;
  if (begins_anew || request.kind == PlanKind::another_way) {
    prefers_wide_margins_ = trip.prefers_wide_margins;
    plan_around(blind_m);
  }
  switch (request.kind) {
    case PlanKind::extension:
      return extension(query);
    case PlanKind::review:
      // Sampling planners are too slow to run while the robot drives: it brakes and replans at rest.
      if (sampling_method(options_.planner.kind)) return {PathMustBeReplaced{}, std::nullopt};
      return review(route_from(query));
    case PlanKind::replan:
      return replan(route_from(query));
    case PlanKind::another_way:
      return another_way(query);
    case PlanKind::new_goal:
      return to_goal(query);
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

TripPlan TripPlanner::another_way(const TripQuery& query) const {
  const std::optional<double> heading_rad = final_heading(query);
  const PlanResult result = plan_over(goals_of(query), query.map_from_base, heading_rad, context_->planner);
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return {PathNotFound{}, std::nullopt};
  const Route route{plan->path, heading_rad};
  return {along(route),
          RouteUpdate{.route = route, .change = RouteChange::more_certain, .failure = std::nullopt}};
}

TripPlan TripPlanner::to_goal(const TripQuery& query) {
  const std::vector<Goal> goals = goals_of(query);
  const std::optional<double> heading_rad = final_heading(query);
  const PlanResult result = first_of([&](const MarginPlanner& planner) {
    return plan_over(goals, query.map_from_base, heading_rad, planner);
  });
  RouteUpdate update{.route = {{}, heading_rad}, .change = RouteChange::new_goal, .failure = {}};
  if (const auto* failure = std::get_if<PlanFailure>(&result)) {
    update.failure = *failure;
    return {PathNotFound{}, update};
  }
  update.route.path = std::get<Plan>(result).path;
  return {along(update.route), update};
}

/// From the end of the present path, which the robot reaches with the heading of its last leg.
TripPlan TripPlanner::extension(const TripQuery& query) {
  Path path = query.trip.drive.path_ahead();
  const std::size_t count = std::min(query.trip.goals_beyond, query.goals.size());
  const std::span<const Goal> goals = std::span(query.goals).last(count);
  if (goals.empty() || path.waypoints_m.size() < 2) return {PathNotFound{}, std::nullopt};
  const Vec2 end_m = path.waypoints_m.back();
  const Pose2 end{end_m, heading_between(path.waypoints_m[path.waypoints_m.size() - 2], end_m)};
  const std::optional<double> heading_rad = end_heading(goals.back());
  const PlanResult result =
      first_of([&](const MarginPlanner& planner) { return plan_over(goals, end, heading_rad, planner); });
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return {PathNotFound{}, std::nullopt};
  const std::vector<Vec2>& tail = plan->path.waypoints_m;
  const std::array leg{path.waypoints_m[path.waypoints_m.size() - 2], end_m,
                       tail[std::min<std::size_t>(1, tail.size() - 1)]};
  const bool passes_end = is_straight(leg, context_->planner);
  path.waypoints_m.insert(path.waypoints_m.end(), tail.begin() + 1, tail.end());
  const double blend_corridor_m = context_->drive_options(path, options_.drive).blend_corridor_m;
  return {PathExtended{plan->path, passes_end, heading_rad, blend_corridor_m},
          RouteUpdate{.route = {path, heading_rad}, .change = RouteChange::extended, .failure = {}}};
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

RouteUpdate TripPlanner::route_from(const TripQuery& query) {
  Route route{query.trip.drive.path_ahead(), final_heading(query)};
  const Pose2& pose = query.map_from_base;
  if (query.request.leg_from_here) route.path.waypoints_m.front() = pose.position_m;
  const auto update_on = [&](const MarginPlanner& planner) {
    return updated(route, pose, planner, options_.route,
                   [&] { return plan_over(goals_of(query), pose, route.goal_heading_rad, planner); });
  };
  RouteUpdate update = first_of(update_on);
  if (!obstacles_.path_is_passable || !way_of(update) || update.change == RouteChange::kept) return update;
  RouteUpdate tight = update_on(tight_planner());
  const bool is_left = tight.change != RouteChange::kept ||
                       !is_too_long(length_m(update.route.path), length_m(tight.route.path), to_leave_a_way);
  return is_left ? update : tight;
}

PathFound TripPlanner::along(const Route& route) const {
  const DriveOptions drive = context_->drive_options(route.path, options_.drive);
  return {RotateThenDrive(route.path, route.goal_heading_rad, drive)};
}

}  // namespace lodestar
