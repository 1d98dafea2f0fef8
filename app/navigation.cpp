#include "app/navigation.hpp"

namespace lodestar {
namespace {

DetectorOptions expecting(const MarkerRegistry& registry, DetectorOptions options) {
  options.registered_ids = registered_ids(registry);
  return options;
}

}  // namespace

Navigation::Navigation(const KnownWorld& world, const NavigationOptions& options)
    : world_(world),
      options_(options),
      detector_(expecting(world.registry, options.detector)),
      planner_(world.map, options.planner),
      filter_(options.filter) {}

NavigationStep Navigation::step(const SensorInput& input) {
  // Travel comes first: a frame was exposed before the newest wheel reading, and the filter corrects the
  // past.
  PoseFilter filter = filter_;
  for (const WheelTravel& travel : input.base.travel) filter.add_travel(travel);
  std::vector<UsedFix> fixes = see(input.frames, filter);

  const std::optional<PoseEstimate> estimate = filter.estimate();
  const std::optional<StopReason> stop = reason_to_stop(input.now, estimate, options_.safety);
  const Duration elapsed = last_step_ ? input.now - *last_step_ : Duration::zero();
  std::optional<RotateThenDrive> drive = drive_;
  BodyVelocity command;
  if (drive) command = stop ? drive->slow_down(elapsed) : drive->update(*estimate, elapsed);

  filter_ = std::move(filter);
  estimate_ = estimate;
  drive_ = std::move(drive);
  last_step_ = input.now;
  return {.fixes = std::move(fixes), .estimate = estimate, .stop = stop, .command = command};
}

std::vector<UsedFix> Navigation::see(const std::vector<Frame>& frames, PoseFilter& filter) {
  std::vector<UsedFix> fixes;
  for (const Frame& frame : frames) {
    const std::vector<DetectedMarker> markers = detector_.detect(frame.gray);
    const std::optional<PoseFix> fix =
        fix_pose(frame.stamp, markers, world_.registry, world_.camera, options_.fix);
    if (!fix) continue;
    const PlanarFix planar = compensate_mount(*fix, world_.base_from_camera);
    fixes.push_back({.fix = *fix, .planar = planar, .outcome = filter.add_fix(planar)});
  }
  return fixes;
}

std::optional<PlanResult> Navigation::go_to(const Goal& goal) {
  drive_.reset();
  if (!estimate_) return std::nullopt;
  const Pose2& pose = estimate_->map_from_base;
  PlanResult result = planner_.plan(pose.position_m, goal.position_m,
                                    {.start_rad = pose.yaw_rad, .goal_rad = goal.heading_rad});
  if (const auto* plan = std::get_if<Plan>(&result)) {
    drive_.emplace(plan->path, goal.heading_rad, options_.drive);
  }
  return result;
}

}  // namespace lodestar
