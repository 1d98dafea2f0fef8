#include "app/placement/explorer.hpp"

#include <algorithm>

#include "app/navigation/navigation_setup.hpp"
#include "planning/collision_checker.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {
namespace {

/// Neighbouring lanes see the same markers: 0.8 of the width that the camera covers at every heading.
double spacing_m(const Site& site, const CameraModel& camera, double ceiling_m) {
  constexpr double overlap = 0.8;
  const double height_m = ceiling_m - site.robot.base_from_camera.translation().z();
  const double half_side_px = 0.5 * std::min(camera.width_px, camera.height_px);
  const double reach_m = height_m * half_side_px / std::max(camera.fx_px, camera.fy_px);
  return std::clamp(2.0 * overlap * reach_m, 0.8, 4.0);
}

double outer_radius_m(const Robot& robot) {
  double radius_m = robot.radius_m;
  if (robot.footprint)
    for (const Vec2& corner : robot.footprint->corners_m()) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

}  // namespace

Explorer::Explorer(const Site& site, const std::string& camera, const PlacedStart& start,
                   const ExplorerOptions& options)
    : options_(options) {
  const double radius_m = outer_radius_m(site.robot);
  const CollisionChecker roomy(drivable_map(site), radius_m + options.margin_m);
  const CollisionChecker passable(roomy.shared_field(), radius_m + default_margins_m.back());
  const CoverageLanesOptions lanes{.spacing_m = spacing_m(site, site.cameras.at(camera), options.ceiling_m)};
  for (const Lane& lane : coverage_lanes(roomy, passable, start.map_from_base.position_m, lanes))
    lanes_.push_back({.lane = lane});
}

std::optional<Goal> Explorer::next(const Vec2& here_m, const SurveyProgress* progress) {
  if (!now_) now_ = nearest_lane(here_m);
  if (!now_ && progress != nullptr) now_ = crossing(*progress);
  return now_ ? std::optional(goal_of(*now_)) : std::nullopt;
}

void Explorer::reached() {
  if (!now_) return;
  if (now_->is_on_lane)
    now_.reset();
  else
    now_->is_on_lane = true;
}

/// Once more later: markers found meanwhile may make the way certain enough.
void Explorer::failed(const std::optional<Vec2>& here_m) {
  if (!now_) return;
  if (here_m && (goal_of(*now_).position_m - *here_m).norm() < options_.near_m) {
    reached();
    return;
  }
  Task task = *std::exchange(now_, std::nullopt);
  task.is_on_lane = false;
  if (++task.failures < options_.most_failures)
    lanes_.push_back(task);
  else
    ++given_up_;
}

Goal Explorer::goal_of(const Task& task) const {
  return {.position_m = task.is_on_lane ? task.lane.to_m : task.lane.from_m, .heading_rad = std::nullopt};
}

/// By its nearer end; those that have failed come last.
std::optional<Explorer::Task> Explorer::nearest_lane(const Vec2& here_m) {
  const auto key = [&](const Task& task) {
    const double way_m = std::min((task.lane.from_m - here_m).norm(), (task.lane.to_m - here_m).norm());
    return std::pair(task.failures, way_m);
  };
  const auto nearest = std::ranges::min_element(lanes_, {}, key);
  if (nearest == lanes_.end()) return std::nullopt;
  Task task = *nearest;
  lanes_.erase(nearest);
  if ((task.lane.to_m - here_m).norm() < (task.lane.from_m - here_m).norm())
    std::swap(task.lane.from_m, task.lane.to_m);
  return task;
}

/// From below one marker to below the other.
std::optional<Explorer::Task> Explorer::crossing(const SurveyProgress& progress) {
  const auto place_of = [&](int id) {
    const auto marker = std::ranges::find(progress.survey.markers, id, &RegisteredMarker::id);
    return progress.map_from_survey * Vec2(marker->position_m.head<2>());
  };
  for (const MarkerLink& link : progress.links) {
    if (link.sigma_m <= progress.target_sigma_m || crossed_.size() >= options_.most_crossings) break;
    if (!crossed_.insert({link.first, link.second}).second) continue;
    return Task{.lane = {place_of(link.first), place_of(link.second)},
                .failures = options_.most_failures - 1};
  }
  return std::nullopt;
}

}  // namespace lodestar
