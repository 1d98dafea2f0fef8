#include "app/navigation/navigation.hpp"

#include <algorithm>
#include <utility>

#include "control/differential_drive.hpp"

namespace lodestar {

Navigation::Navigation(const KnownWorld& world, const NavigationOptions& options)
    : options_(options),
      localizer_(world.registry, world.camera, world.base_from_camera, options.detector, options.fix,
                 options.filter),
      ground_(std::make_unique<const PlanningContext>(world.map, options.planner, Margins::usual)),
      known_{PoseFilter(options.filter), MarkerTrust(options.trust), CameraWatch(options.camera),
             IntegrityMonitor(options.doubt)},
      motion_{.spin = Spin(options.spin),
              .on_the_spot = RotateThenDrive({}, std::nullopt, options.drive),
              .places = Backtrack(options.backtrack)} {}

NavigationStep Navigation::step(const SensorInput& input) {
  // Travel comes first: a frame was exposed before the newest wheel reading, and the filter corrects the
  // past.
  NavigationStep step;
  LocalizationState known = known_;
  for (const WheelTravel& travel : input.base.travel) known.add_travel(travel);
  for (const Frame& frame : input.frames)
    if (std::optional<FixAttempt> used = localizer_.see(frame, input.now, known))
      step.fixes.push_back(std::move(*used));

  step.estimate = known.filter.estimate();
  const auto reason_within = [&](const SafetyStopOptions& limits) {
    return with_doubts(reason_to_stop(input.now, step.estimate, limits), known, input.now);
  };
  step.stop = reason_within(options_.safety);
  step.camera = known.camera.fault(input.now);
  step.rolled_unseen_m = known.integrity.rolled_since_agreement_m();
  step.distrusted = known.trust.distrusted();
  step.wheel_scales = known.filter.wheel_scales();
  const Situation at{.now = input.now,
                     .elapsed = last_step_ ? input.now - *last_step_ : Duration::zero(),
                     .turned_rad = input.base.travel.empty()
                                       ? turned_rad_
                                       : turned_rad(input.base.travel.back(), options_.drive.track_width_m),
                     .estimate = step.estimate,
                     .stop_on_backtrack = reason_within(options_.backtrack.limits),
                     .is_contradicted = known.integrity.is_contradicted()};
  Motion motion = motion_;
  if (step.estimate) remember_place(motion, step);
  if (motion.places.was_in_vain() && !motion.backtrack && !step.stop) step.stop = StopReason::pose_stale;
  if (motion.seeks_another_way && motion.drive && !motion.drive->paused() && !motion.backtrack && !step.stop)
    take_another_way(motion, step.estimate->map_from_base, step);
  step.command = move(motion, at, step);

  known_ = std::move(known);
  estimate_ = step.estimate;
  motion_ = std::move(motion);
  turned_rad_ = at.turned_rad;
  last_step_ = input.now;
  return step;
}

/// As one where a marker was seen, or none.
void Navigation::remember_place(Motion& motion, const NavigationStep& step) {
  const Vec2& here_m = step.estimate->map_from_base.position_m;
  const bool has_agreed =
      std::ranges::find(step.fixes, FixOutcome::accepted, &FixAttempt::outcome) != step.fixes.end();
  if (!has_agreed) {
    motion.places.saw_nothing_at(here_m);
    return;
  }
  motion.places.saw_marker_at(here_m);
  motion.is_lost = false;
  if (motion.backtrack && motion.places.is_far_from_its_end(here_m)) motion.backtrack->cancel();
}

BodyVelocity Navigation::move(Motion& motion, const Situation& at, NavigationStep& step) const {
  if (step.stop && is_for_good(*step.stop)) motion.drive.reset();
  if (!motion.drive) motion.backtrack.reset();
  if (!motion.drive) {
    if (!looks_for_markers_) return {};
    const std::optional<double> look = motion.spin.update(at.now, step.stop, at.turned_rad);
    return motion.on_the_spot.turn_around(look.value_or(0.0), at.elapsed);
  }
  RotateThenDrive& drive = *motion.drive;
  const bool may_look = !drive.paused() && !drive.arrived();
  motion.is_lost = motion.is_lost || (may_look && step.stop && would_a_marker_mend(*step.stop));
  // While it braked it may have passed the narrow place that it was too unsure for.
  if (motion.is_lost && !step.stop && drive.at_rest() && !is_stuck(limit_in_doubt(at)))
    motion.is_lost = false;
  if (!motion.backtrack && motion.is_lost && !at.stop_on_backtrack && may_look && motion.places.possible()) {
    const bool may_go_on = !step.stop;
    if (may_go_on) step.stop = StopReason::pose_uncertain;
    if (!drive.at_rest()) return drive.slow_down(at.elapsed);
    if (!motion.keeps_to_the_middle && may_go_on) {
      motion.keeps_to_the_middle = motion.seeks_another_way = true;
      motion.is_lost = false;
      return {};
    }
    motion.backtrack = way_back(motion, at.estimate->map_from_base);
    motion.is_lost = false;
  }
  if (motion.backtrack) return go_back(motion, at, step);
  const std::optional<double> look =
      motion.spin.update(at.now, may_look ? step.stop : std::nullopt, at.turned_rad);
  BodyVelocity command;
  if (look) {
    command = drive.turn_around(*look, at.elapsed);
  } else if (step.stop) {
    command = drive.slow_down(at.elapsed);
  } else {
    command = follow(motion, at, step);
  }
  if (motion.drive && motion.drive->phase() == DrivePhase::cancelled) motion.drive.reset();
  return command;
}

/// Along the path, or to rest when it must be planned anew.
BodyVelocity Navigation::follow(Motion& motion, const Situation& at, NavigationStep& step) const {
  const Pose2& pose = at.estimate->map_from_base;
  motion.is_lost = false;
  if (!motion.drive->paused() && !motion.drive->arrived()) reroute(motion, pose, step);
  if (!motion.drive) return {};
  if (motion.reroutes) return motion.drive->slow_down(at.elapsed);

  const SpeedLimit limit = limit_in_doubt(at);
  const BodyVelocity command = motion.drive->update(*at.estimate, at.elapsed, limit);
  const bool is_blocked = is_stuck(limit) && motion.drive->phase() == DrivePhase::driving;
  if (is_blocked && !is_stuck(speed_limit(at, {}, options_.safety))) {
    step.stop = StopReason::pose_uncertain;
    motion.is_lost = true;
    return command;
  }
  if (is_blocked) step.stop = StopReason::way_blocked;
  if (is_blocked && !motion.is_blocked) motion.looks_again = true;
  motion.is_blocked = is_blocked;
  return command;
}

/// Back to where a marker was seen last, on a way that the robot knows to be free.
BodyVelocity Navigation::go_back(Motion& motion, const Situation& at, NavigationStep& step) const {
  RotateThenDrive& backtrack = *motion.backtrack;
  if (at.stop_on_backtrack) {
    step.stop = at.stop_on_backtrack;
    const BodyVelocity command = backtrack.slow_down(at.elapsed);
    if (backtrack.at_rest()) motion.backtrack.reset();
    return command;
  }
  step.stop.reset();
  step.backtracks = true;
  motion.is_lost = false;
  const SpeedLimit limit =
      speed_limit(at, room_on_the_way_back(at.estimate->covariance), options_.backtrack.limits);
  const bool is_blocked = is_stuck(limit) && backtrack.phase() == DrivePhase::driving;
  const BodyVelocity command =
      is_blocked ? backtrack.slow_down(at.elapsed) : backtrack.update(*at.estimate, at.elapsed, limit);
  if (backtrack.arrived()) motion.places.came_back();
  const bool has_ended = backtrack.arrived() || backtrack.phase() == DrivePhase::cancelled;
  if (has_ended || (is_blocked && backtrack.at_rest())) motion.backtrack.reset();
  return command;
}

/// First along the leg by which it has come: every other way may be narrower.
std::optional<RotateThenDrive> Navigation::way_back(Motion& motion, const Pose2& pose) const {
  constexpr double beside_leg_m = 0.3;
  const std::optional<Vec2> place_m = motion.places.begin();
  if (!place_m) return std::nullopt;
  motion.seeks_another_way = true;
  const std::vector<Vec2> ahead_m = motion.drive->path_ahead().waypoints_m;
  const bool is_on_leg =
      ahead_m.size() > 1 && distance_to_path_m({{ahead_m[0], ahead_m[1]}}, pose.position_m) <= beside_leg_m;
  const Vec2 from_m = is_on_leg ? ahead_m.front() : pose.position_m;
  if (distance_to_path_m({{from_m, pose.position_m}}, *place_m) <= beside_leg_m)
    return RotateThenDrive({{pose.position_m, *place_m}}, std::nullopt, options_.drive);
  const MarginPlanner planner(ground_->map, options_.planner, margins_m(Margins::wide));
  const PlanResult result = planner.plan(from_m, *place_m);
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return std::nullopt;
  Path path = plan->path;
  if (is_on_leg) path.waypoints_m.insert(path.waypoints_m.begin(), pose.position_m);
  return RotateThenDrive(path, std::nullopt, options_.drive);
}

void Navigation::drive_along(const Path& path, Motion& motion) const {
  motion.drive.emplace(path, motion.goal_heading_rad, ground_->drive_options(path, options_.drive));
}

/// An unsure robot keeps away from what it could touch; and where it has found no marker it drives again only
/// if every other way is far longer.
void Navigation::take_another_way(Motion& motion, const Pose2& pose, NavigationStep& step) {
  motion.seeks_another_way = false;
  motion.reroutes = false;
  ground_ = ground_over(ground_->map, motion);
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = motion.goal_heading_rad};
  const Vec2 goal_m = motion.drive->path_ahead().waypoints_m.back();
  const PlanResult result = ground_->planner.plan(pose.position_m, goal_m, headings);
  const auto* plan = std::get_if<Plan>(&result);
  if (plan == nullptr) return;
  drive_along(plan->path, motion);
  step.reroute = {
      .route = {plan->path, motion.goal_heading_rad}, .change = RouteChange::surer, .failure = std::nullopt};
}

std::unique_ptr<const PlanningContext> Navigation::ground_over(const OccupancyMap& map,
                                                               const Motion& motion) const {
  GridPlannerOptions options = options_.planner;
  const std::span<const Vec2> blind_m = motion.places.blind_ground_m();
  options.shunned.places_m.assign(blind_m.begin(), blind_m.end());
  const bool is_unsure = motion.keeps_to_the_middle || !blind_m.empty();
  return std::make_unique<const PlanningContext>(map, options, is_unsure ? Margins::wide : Margins::usual);
}

/// A path that no longer holds is given up in two steps: the robot comes to rest, and plans from where it
/// stands then.
void Navigation::reroute(Motion& motion, const Pose2& pose, NavigationStep& step) const {
  const bool is_off_path =
      distance_to_path_m(motion.drive->path_ahead(), pose.position_m) > options_.route.left_path_m;
  if (!motion.reroutes) {
    if (!motion.looks_again && !is_off_path) return;
    motion.looks_again = false;
    motion.reroutes =
        sampling_method(options_.planner.kind) || route_from(motion, pose).change != RouteChange::kept;
  }
  if (!motion.reroutes || !motion.drive->at_rest()) return;
  motion.reroutes = false;
  const RouteUpdate update = route_from(motion, pose);
  if (update.change == RouteChange::kept) return;
  motion.drive.reset();
  if (update.change != RouteChange::lost) drive_along(update.route.path, motion);
  step.reroute = update;
}

RouteUpdate Navigation::route_from(const Motion& motion, const Pose2& pose) const {
  Route route{motion.drive->path_ahead(), motion.goal_heading_rad};
  // What blocks a robot that is on its way lies between it and the leg's end, not on the leg.
  if (motion.is_blocked) route.path.waypoints_m.front() = pose.position_m;
  return updated(route, pose, ground_->planner, options_.route);
}

std::optional<PlanResult> Navigation::go_to(const Goal& goal) {
  motion_.drive.reset();
  motion_.backtrack.reset();
  motion_.places.new_goal();
  motion_.looks_again = motion_.reroutes = motion_.is_blocked = motion_.is_lost = false;
  motion_.seeks_another_way = false;
  if (std::exchange(motion_.keeps_to_the_middle, false)) ground_ = ground_over(ground_->map, motion_);
  if (!estimate_) return std::nullopt;
  const Pose2& pose = estimate_->map_from_base;
  const PlanHeadings headings{.start_rad = pose.yaw_rad, .goal_rad = goal.heading_rad};
  PlanResult result = ground_->planner.plan(pose.position_m, goal.position_m, headings);
  if (const auto* plan = std::get_if<Plan>(&result)) {
    motion_.goal_heading_rad = goal.heading_rad;
    drive_along(plan->path, motion_);
  }
  return result;
}

void Navigation::map_changed(const OccupancyMap& map) {
  ground_ = ground_over(map, motion_);
  motion_.looks_again = true;
}

SpeedLimit Navigation::speed_limit(const Situation& at, const SafetyMargin& spare,
                                   const SafetyStopOptions& limits) const {
  CautionOptions caution = options_.caution;
  if (at.is_contradicted) caution.swing_per_m = caution.contradicted_swing_per_m;
  return safe_speed(ground_->forward_clearance, *at.estimate, spare, {options_.drive, caution, limits});
}

/// As speed_limit(), with room kept for what the robot does not know of its place; none where it has less.
SpeedLimit Navigation::limit_in_doubt(const Situation& at) const {
  const SafetyMargin spare = room_for_doubt(at.estimate->covariance);
  SpeedLimit limit = speed_limit(at, spare, options_.safety);
  const double room_m = ground_->forward_clearance.room_m(at.estimate->map_from_base.position_m);
  if (spare.here_m > 0.0 && room_m < spare.here_m) limit.forward_mps = 0.0;
  return limit;
}

bool Navigation::place_robot(const Pose2& map_from_base) {
  constexpr double position_sigma_m = 0.25;
  constexpr double heading_sigma_rad = radians(10.0);
  if (!last_step_) return false;
  PlanarFix said{.stamp = *last_step_, .map_from_base = map_from_base, .covariance = Eigen::Matrix3d::Zero()};
  said.covariance.diagonal() = Vec3(position_sigma_m, position_sigma_m, heading_sigma_rad).array().square();
  known_.integrity = IntegrityMonitor(options_.doubt);
  return known_.filter.start_at(said);
}

void Navigation::halt() {
  motion_.drive.reset();
  motion_.backtrack.reset();
  looks_for_markers_ = false;
}

void Navigation::pause() {
  if (motion_.drive) motion_.drive->pause();
  if (motion_.backtrack) motion_.backtrack->pause();
}

void Navigation::resume() {
  if (motion_.drive) motion_.drive->resume();
  if (motion_.backtrack) motion_.backtrack->resume();
}

void Navigation::cancel() {
  if (motion_.drive) motion_.drive->cancel();
  if (motion_.backtrack) motion_.backtrack->cancel();
}

}  // namespace lodestar
