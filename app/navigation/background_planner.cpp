#include "app/navigation/background_planner.hpp"

#include <utility>
#include <vector>

namespace lodestar {

BackgroundPlanner::BackgroundPlanner(const OccupancyMap& map, const TripPlannerOptions& options,
                                     const PlanArrivalOptions& arrival, std::vector<KeepOut> keep_out)
    : robot_(options.planner), keep_out_(std::move(keep_out)), arrival_(arrival) {
  prepared_ = prepared_on(map, keep_out_);
  planner_.emplace(prepared_.drivable, options);
}

/// Also on the worker: reads nothing that changes.
BackgroundPlanner::Prepared BackgroundPlanner::prepared_on(OccupancyMap map,
                                                           std::span<const KeepOut> keep_out) const {
  Prepared prepared;
  if (!keep_out.empty())
    prepared.drivable = std::make_shared<const ObstacleField>(with_keep_out(map, keep_out));
  prepared.map = std::make_shared<const ObstacleField>(std::move(map));
  if (!prepared.drivable) prepared.drivable = prepared.map;
  prepared.forward_clearance =
      robot_.footprint ? std::make_shared<const ForwardClearance>(prepared.drivable, *robot_.footprint)
                       : std::make_shared<const ForwardClearance>(prepared.drivable, robot_.radius_m);
  return prepared;
}

/// Waits for its turn, with the obstacles that are planned around.
BackgroundPlanner::Ground& BackgroundPlanner::next_ground() {
  if (!next_) next_ = Ground{.map = std::nullopt, .obstacles = obstacles_};
  return *next_;
}

void BackgroundPlanner::use_map(OccupancyMap map) {
  Ground& next = next_ground();
  next.map = std::move(map);
  next.obstacles = obstacles_ = {};
}

void BackgroundPlanner::use_obstacles(UnmappedObstacles obstacles) {
  obstacles_ = std::move(obstacles);
  next_ground().obstacles = obstacles_;
}

void BackgroundPlanner::use_keep_out(std::vector<KeepOut> keep_out) {
  keep_out_ = std::move(keep_out);
  next_ground().has_other_keep_out = true;
}

template <typename Awaited, typename Result>
bool BackgroundPlanner::has_arrived(const Awaited& awaited, const std::future<Result>& result) const {
  if (step_ < awaited.due) return false;
  return arrival_.waits || result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

bool BackgroundPlanner::begin_step(std::span<const Vec2> blind_m) {
  ++step_;
  if (awaited_ && has_arrived(*awaited_, awaited_->prepared)) {
    std::future<Prepared> prepared = std::move(awaited_->prepared);
    awaited_.reset();
    prepared_ = prepared.get();
  }
  bool is_changed = std::exchange(review_is_due_, false);
  if (next_ && !awaited_) {
    prepare_next(blind_m);
    is_changed = true;
  }
  return is_changed;
}

void BackgroundPlanner::prepare_next(std::span<const Vec2> blind_m) {
  auto prepare = [this, ground = std::move(*next_), before = prepared_, keep_out = keep_out_,
                  blind = std::vector<Vec2>(blind_m.begin(), blind_m.end())]() mutable {
    if (!ground.map && ground.has_other_keep_out) ground.map = before.map->map();
    const Prepared prepared = ground.map ? prepared_on(std::move(*ground.map), keep_out) : before;
    planner_->use_map(prepared.drivable, std::move(ground.obstacles), blind);
    return prepared;
  };
  next_.reset();
  awaited_ = {.prepared = worker_.run(std::move(prepare)), .due = step_ + arrival_.steps};
  if (plan_) plan_->is_on_old_map = true;
}

void BackgroundPlanner::ask(TripQuery query) {
  drop();
  PlanRequest request = query.request;
  std::stop_source dropped;
  auto plan = [this, query = std::move(query), is_dropped = dropped.get_token()] {
    return is_dropped.stop_requested() ? TripPlan{PathNotFound{}, std::nullopt} : planner_->plan(query);
  };
  plan_ = {.request = std::move(request),
           .answer = worker_.run(std::move(plan)),
           .dropped = std::move(dropped),
           .due = step_ + arrival_.steps};
}

/// On a robot, the worker skips a dropped plan that it has not begun: the next one must not wait for it. In a
/// replay it makes all of them, as the planner keeps its margins from one to the next.
void BackgroundPlanner::drop() {
  if (plan_ && !arrival_.waits) plan_->dropped.request_stop();
  plan_.reset();
}

std::optional<TripPlan> BackgroundPlanner::take() {
  if (!plan_ || !has_arrived(*plan_, plan_->answer)) return std::nullopt;
  AwaitedPlan arrived = std::move(*plan_);
  plan_.reset();
  review_is_due_ = arrived.is_on_old_map;
  return arrived.answer.get();
}

}  // namespace lodestar
