#include "app/replay.hpp"

#include <algorithm>
#include <thread>

#include "app/mission.hpp"
#include "app/navigation_setup.hpp"
#include "app/report/run_recorder.hpp"
#include "app/stopwatch.hpp"
#include "drivers/simulation.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

SimulationOptions simulation_options(const Site& site, const ReplayOptions& replay) {
  SimulationOptions options;
  options.start = site.start;
  options.base_from_camera = site.robot.base_from_camera;
  options.robot_radius_m = site.robot.radius_m;
  options.base.track_width_m = site.robot.track_width_m;
  options.seed = replay.seed;
  options.faults = replay.faults;
  return options;
}

SensorInput sense(Simulation& simulation, BaseDriver& base) {
  SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
  while (std::optional<Frame> frame = simulation.camera().poll()) input.frames.push_back(std::move(*frame));
  return input;
}

/// Tells the judge what has come of a goal, and records his score.
void judge(RunRecord& record, Scorer& scorer, const Mission& mission, MissionEvent event) {
  if (event == MissionEvent::path_planned) scorer.claim_path(mission.path());
  if (event != MissionEvent::goal_arrived) return;
  GoalRecord& goal = record.goals.at(mission.current() - 1);
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
  const Stopwatch watch;
  const KnownWorld world = known_world(site, options.camera);
  Simulation simulation(world.map, world.registry, world.camera, simulation_options(site, options));
  BaseDriver base(simulation.can());
  NavigationOptions navigation = navigation_options(site.robot);
  navigation.planner.kind = options.planner;
  navigation.planner.sampling.seed = static_cast<std::uint32_t>(options.seed % 2147483647U + 1U);
  Mission mission(world, navigation, options.goals);

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
    const Stopwatch computing;
    const MissionStep step = mission.step(input);
    if (options.on_step) options.on_step(computing.elapsed());
    base.command(step.navigation.command);

    record_step(record, input, step.navigation);
    record_event(record, mission, step.event, simulation.now());
    judge(record, simulation.scorer(), mission, step.event);
    if (options.progress) options.progress(share_done(record, mission, step.navigation.estimate));
    if (options.realtime) std::this_thread::sleep_for(simulation.now().time_since_epoch() - watch.elapsed());
  }

  record.truth = simulation.scorer().track();
  record.path_distances_m = simulation.scorer().path_distances_m();
  record.contacts = simulation.scorer().contacts();
  record.faults = simulation.faults();
  record.wall_time_s = watch.seconds();
  return record;
}

}  // namespace lodestar
