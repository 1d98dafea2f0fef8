#include "app/replay.hpp"

#include <algorithm>
#include <thread>

#include "app/mission.hpp"
#include "app/navigation_setup.hpp"
#include "drivers/simulation.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

SimulationOptions simulation_options(const Site& site, std::uint64_t seed) {
  SimulationOptions options;
  options.start = site.start;
  options.base_from_camera = site.robot.base_from_camera;
  options.robot_radius_m = site.robot.radius_m;
  options.base.track_width_m = site.robot.track_width_m;
  options.seed = seed;
  return options;
}

SensorInput sense(Simulation& simulation, BaseDriver& base) {
  SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
  while (std::optional<Frame> frame = simulation.camera().poll()) input.frames.push_back(std::move(*frame));
  return input;
}

void record_step(RunRecord& record, const SensorInput& input, const NavigationStep& step) {
  record.frames += static_cast<int>(input.frames.size());
  for (const UsedFix& used : step.fixes) {
    const bool accepted =
        used.outcome != FixOutcome::refused_gate && used.outcome != FixOutcome::refused_late;
    record.fixes.push_back({.stamp = used.fix.stamp,
                            .map_from_base = used.planar.map_from_base,
                            .ids = used.fix.ids,
                            .confidence = used.fix.confidence,
                            .accepted = accepted});
  }
  record.distrusted = step.distrusted;
  if (!step.estimate) return;
  record.steps.push_back({.estimate = *step.estimate,
                          .commanded = step.command,
                          .measured = input.base.measured.value_or(BodyVelocity{})});
}

/// Tells the judge and the record what has come of a goal.
void record_event(RunRecord& record, Scorer& scorer, const Mission& mission, MissionEvent event, Stamp now) {
  if (event == MissionEvent::none) return;
  if (event == MissionEvent::path_planned) {
    GoalRecord& goal = record.goals.at(mission.current());
    goal.planned = mission.path();
    goal.travel_time = -now.time_since_epoch();
    scorer.claim_path(mission.path());
    return;
  }
  GoalRecord& goal = record.goals.at(mission.current() - 1);
  if (!goal.planned.waypoints_m.empty()) goal.travel_time += now.time_since_epoch();
  goal.ended = now;
  if (event == MissionEvent::goal_failed) {
    goal.failure = mission.failure();
    return;
  }
  goal.arrived = true;
  scorer.claim_arrival(goal.goal.position_m, goal.goal.heading_rad);
  goal.score = scorer.arrivals().back();
}

/// The share of the goals done, the present one by the way still to go.
double share_done(const RunRecord& record, const Mission& mission,
                  const std::optional<PoseEstimate>& estimate) {
  const auto total = static_cast<double>(record.goals.size());
  const auto done = static_cast<double>(mission.current());
  if (mission.finished() || !estimate || record.goals[mission.current()].planned.waypoints_m.empty())
    return done / total;
  const Path& path = mission.path();
  const double left_m = (path.waypoints_m.back() - estimate->map_from_base.position_m).norm();
  return (done + 1.0 - std::clamp(left_m / std::max(length_m(path), 1e-9), 0.0, 1.0)) / total;
}

}  // namespace

RunRecord replay(const Site& site, const ReplayOptions& options) {
  const auto wall_start = std::chrono::steady_clock::now();
  const KnownWorld world = known_world(site, options.camera);
  Simulation simulation(world.map, world.registry, world.camera, simulation_options(site, options.seed));
  BaseDriver base(simulation.can());
  Mission mission(world, navigation_options(site.robot), options.goals);

  RunRecord record;
  record.site = site.name;
  record.camera = options.camera;
  record.seed = options.seed;
  record.start = site.start;
  record.robot_radius_m = site.robot.radius_m;
  for (const Goal& goal : options.goals) record.goals.push_back({.goal = goal});
  simulation.on_can_frame([&record](const StampedCanFrame& frame) { record.can_frames.push_back(frame); });

  while (!mission.finished()) {
    simulation.advance(control_period);
    const SensorInput input = sense(simulation, base);
    const MissionStep step = mission.step(input);
    base.command(step.navigation.command);

    record_step(record, input, step.navigation);
    record_event(record, simulation.scorer(), mission, step.event, simulation.now());
    if (options.progress) options.progress(share_done(record, mission, step.navigation.estimate));
    if (options.realtime) std::this_thread::sleep_until(wall_start + simulation.now().time_since_epoch());
  }

  record.truth = simulation.scorer().track();
  record.path_distances_m = simulation.scorer().path_distances_m();
  record.contacts = simulation.scorer().contacts();
  record.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  return record;
}

}  // namespace lodestar
