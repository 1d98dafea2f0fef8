#include "app/navigation.hpp"

#include <algorithm>

namespace lodestar {
namespace {

/// How far the wheels say that the robot has turned, up to a factor near 1.
std::optional<double> turned_by(const std::vector<WheelTravel>& travel, double track_width_m) {
  if (travel.empty()) return std::nullopt;
  return (travel.back().right_m - travel.back().left_m) / track_width_m;
}

}  // namespace

Navigation::Navigation(const KnownWorld& world, const NavigationOptions& options)
    : world_(world),
      options_(options),
      sight_(world.registry, world.camera, world.base_from_camera, options.detector, options.fix,
             options.filter),
      planner_(world.map, options.planner),
      free_way_(world.map, options.planner.radius_m),
      known_{PoseFilter(options.filter), MarkerTrust(options.trust), CameraWatch(options.camera),
             Doubt(options.doubt)},
      look_around_(options.look_around),
      on_the_spot_({}, std::nullopt, options.drive) {}

NavigationStep Navigation::step(const SensorInput& input) {
  // Travel comes first: a frame was exposed before the newest wheel reading, and the filter corrects the
  // past.
  Whereabouts known = known_;
  for (const WheelTravel& travel : input.base.travel) known.add_travel(travel);
  std::vector<UsedFix> fixes;
  for (const Frame& frame : input.frames)
    if (std::optional<UsedFix> used = sight_.see(frame, input.now, known)) fixes.push_back(std::move(*used));

  const std::optional<PoseEstimate> estimate = known.filter.estimate();
  const double turned_rad = turned_by(input.base.travel, options_.drive.track_width_m).value_or(turned_rad_);
  std::optional<StopReason> stop =
      with_doubts(reason_to_stop(input.now, estimate, options_.safety), known, input.now);
  const Duration elapsed = last_step_ ? input.now - *last_step_ : Duration::zero();
  std::optional<RotateThenDrive> drive = drive_;
  LookAround look_around = look_around_;
  RotateThenDrive on_the_spot = on_the_spot_;
  BodyVelocity command;
  if (stop && is_for_good(*stop)) drive.reset();
  if (drive) {
    const bool may_look = !drive->paused() && !drive->arrived();
    const std::optional<double> look =
        look_around.update(input.now, may_look ? stop : std::nullopt, turned_rad);
    if (look) {
      command = drive->turn_around(*look, elapsed);
    } else if (stop) {
      command = drive->slow_down(elapsed);
    } else {
      const SpeedLimit limit = speed_limit(*estimate);
      command = drive->update(*estimate, elapsed, limit);
      const bool blocked = limit.forward_mps < options_.drive.min_forward_mps;
      if (blocked && drive->phase() == DrivePhase::driving) stop = StopReason::way_blocked;
    }
    if (drive->phase() == DrivePhase::cancelled) drive.reset();
  } else if (looks_for_markers_) {
    command = on_the_spot.turn_around(look_around.update(input.now, stop, turned_rad).value_or(0.0), elapsed);
  }

  known_ = std::move(known);
  estimate_ = estimate;
  drive_ = std::move(drive);
  look_around_ = look_around;
  on_the_spot_ = std::move(on_the_spot);
  turned_rad_ = turned_rad;
  last_step_ = input.now;
  return {.fixes = std::move(fixes),
          .estimate = estimate,
          .stop = stop,
          .command = command,
          .camera = known_.camera.fault(input.now),
          .rolled_unseen_m = known_.doubt.rolled_since_agreement_m(),
          .distrusted = known_.trust.distrusted()};
}

std::optional<PlanResult> Navigation::go_to(const Goal& goal) {
  drive_.reset();
  if (!estimate_) return std::nullopt;
  const Pose2& pose = estimate_->map_from_base;
  PlanResult result = planner_.plan(pose.position_m, goal.position_m,
                                    {.start_rad = pose.yaw_rad, .goal_rad = goal.heading_rad});
  if (const auto* plan = std::get_if<Plan>(&result)) {
    drive_.emplace(plan->path, goal.heading_rad, drive_options(plan->path));
  }
  return result;
}

/// The less sure of its pose the slower, and never so fast that the robot could not stop before it meets what
/// lies straight ahead.
SpeedLimit Navigation::speed_limit(const PoseEstimate& estimate) const {
  const DriveOptions& drive = options_.drive;
  const double deceleration = drive.braking_share * drive.max_acceleration_mps2;
  const double reach_m =
      drive.max_forward_mps * (drive.response_s + 0.5 * drive.max_forward_mps / deceleration);
  const double free_m = free_way_.ahead_m(estimate.map_from_base, reach_m);
  const double share = share_of_speed(estimate.covariance, options_.safety, options_.caution);
  return {.forward_mps = std::min(share * drive.max_forward_mps,
                                  speed_to_stop_within(free_m, deceleration, drive.response_s)),
          .turn_radps = share * drive.max_turn_radps};
}

/// Corners are cut only where there is room for it.
DriveOptions Navigation::drive_options(const Path& path) const {
  DriveOptions options = options_.drive;
  for (std::size_t i = 2; i < path.waypoints_m.size(); ++i) {
    const Vec2& waypoint = path.waypoints_m[i - 1];
    const auto corner = corner_at(path.waypoints_m[i - 2], waypoint, path.waypoints_m[i], options_.drive);
    if (!corner) continue;
    const Vec2 begin = waypoint + corner->cut_m * (path.waypoints_m[i - 2] - waypoint).normalized();
    const Vec2 end = waypoint + corner->cut_m * (path.waypoints_m[i] - waypoint).normalized();
    if (!planner_.is_clear(begin, end)) options.blend_corridor_m = 0.0;
  }
  return options;
}

void Navigation::halt() {
  drive_.reset();
  looks_for_markers_ = false;
}

void Navigation::pause() {
  if (drive_) drive_->pause();
}

void Navigation::resume() {
  if (drive_) drive_->resume();
}

void Navigation::cancel() {
  if (drive_) drive_->cancel();
}

}  // namespace lodestar
