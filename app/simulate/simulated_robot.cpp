#include "app/simulate/simulated_robot.hpp"

#include <algorithm>

#include "app/common/stopwatch.hpp"
#include "app/live/operator_session.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/report/run_statistics.hpp"
#include "app/site/base_setup.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

/// The base can brake as hard as the robot declares, with a third to spare for the lag of its motors.
void brake_as_declared(SimulationOptions& options, double protective_deceleration_mps2) {
  options.contacts.protective_deceleration_mps2 = protective_deceleration_mps2;
  double& most_mps2 = options.base.max_wheel_acceleration_mps2;
  most_mps2 = std::max(most_mps2, protective_deceleration_mps2 * 4.0 / 3.0);
}

SimulationOptions simulation_options(const Site& site, const SimulatedDriveOptions& replay) {
  SimulationOptions options;
  options.start = site.start;
  options.base_from_camera = site.robot.base_from_camera;
  options.robot_radius_m = site.robot.radius_m;
  options.robot_footprint = site.robot.footprint;
  options.base.track_width_m = site.robot.track_width_m;
  options.base.max_forward_mps = std::max(options.base.max_forward_mps, site.robot.max_forward_mps);
  options.base.max_turn_radps = std::max(options.base.max_turn_radps, site.robot.max_turn_radps);
  options.base.max_wheel_mps = std::max(options.base.max_wheel_mps, site.robot.max_wheel_mps);
  options.seed = replay.seed;
  options.faults = replay.faults;
  options.disk = replay.disk;
  options.scanner = replay.scanner;
  if (!options.scanner && site.robot.scanner)
    options.scanner = SimulatedScannerOptions{.mount = site.robot.scanner->mount};
  if (site.robot.depth_camera) {
    options.depth_camera = SimulatedDepthCameraOptions{.mount = site.robot.depth_camera->mount};
    options.robot_height_m = site.robot.depth_camera->robot_height_m;
  }
  options.overhangs = replay.overhangs;
  options.discs = replay.discs;
  options.doors = replay.doors;
  options.people = replay.people;
  if (site.charging) {
    options.battery.emplace();
    options.battery->map_from_dock = site.charging->map_from_dock;
    if (replay.battery_v) options.battery->start_v = *replay.battery_v;
  }
  options.others = replay.others;
  if (site.robot.scanner) brake_as_declared(options, site.robot.scanner->protective_deceleration_mps2);
  return options;
}

NavigationOptions replay_navigation(const Site& site, const SimulatedDriveOptions& options) {
  NavigationOptions navigation = navigation_options(site.robot);
  navigation.learned = options.learned;
  navigation.planner.kind = options.planner;
  if (options.is_placed_at_start) {
    // Nothing confirms the pose from there on: it goes by the wheels for as long as the drive lasts.
    navigation.safety.max_time_unseen = std::chrono::hours(1);
    navigation.safety.max_position_sigma_m = 2.0;
    navigation.safety.max_heading_sigma_rad = radians(45.0);
  }
  navigation.planner.uncertainty_constraint = options.uncertainty_constraint;
  navigation.planner.sampling.seed = static_cast<std::uint32_t>(options.seed % 2147483647U + 1U);
  return navigation;
}

MarkerRegistry markers_over(const Site& site, const SimulatedDriveOptions& options) {
  std::vector<Vec2> places_m{site.start.position_m};
  for (const Goal& goal : options.goals) places_m.push_back(goal.position_m);
  return hung_markers(site.registry, options.disturbances, places_m, options.seed);
}

SensorInput sense(Simulation& simulation, BaseDriver& base) {
  SensorInput input{.now = simulation.now(), .frames = {}, .base = base.poll(simulation.now())};
  while (std::optional<Frame> frame = simulation.camera().poll()) input.frames.push_back(std::move(*frame));
  if (Scanner* scanner = simulation.scanner()) {
    while (std::optional<Scan> scan = scanner->poll()) input.scans.push_back(std::move(*scan));
    input.packets = scanner->packets();
  }
  if (DepthCamera* depth = simulation.depth_camera())
    while (std::optional<DepthImage> image = depth->poll()) input.depths.push_back(std::move(*image));
  return input;
}

/// The share of the goals done, the present one by the distance still to go.
double share_done(const DriveRecord& record, const Mission& mission,
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

SimulatedRobot::SimulatedRobot(const Site& site, const SimulatedDriveOptions& options)
    : site_(site),
      options_(options),
      world_(known_world(site, options.camera)),
      simulation_(world_.map, markers_over(site, options), world_.camera,
                  with_disturbances(simulation_options(site, options), options.disturbances)),
      base_(simulation_.can(), base_driver_options(site.robot)),
      mission_(world_, replay_navigation(site, options), options.goals),
      recorder_(site, {.camera = options.camera,
                       .seed = options.seed,
                       .pictures_hz = options.pictures_hz,
                       .pictures_wait = true,
                       .watch = options.watch}) {
  simulation_.on_can_frame([this](const StampedCanFrame& frame) { recorder_.take(frame); });
}

MissionStep SimulatedRobot::step(OperatorSession* session) {
  simulation_.advance(control_period);
  SensorInput input = sense(simulation_, base_);
  if (session != nullptr) input.zones = session->take_zones();
  if (options_.on_input) options_.on_input(input);
  if (options_.is_placed_at_start && !is_placed_)
    is_placed_ = mission_.place_robot(site_.start, {.position_m = 0.02, .heading_rad = radians(1.0)});
  const Stopwatch computing;
  const MissionStep step = mission_.step(input);
  if (options_.on_step) options_.on_step(computing.elapsed());
  base_.command(step.navigation.command);
  if (session != nullptr) session->publish(input, step, mission_, [&] { return error_of(step.navigation); });
  if (!recorder_.is_on()) {
    forget();
    if (options_.attend) options_.attend(input, step, mission_);
    return step;
  }
  recorder_.take(input, step, mission_);
  if (options_.attend) options_.attend(input, step, mission_);
  score(step.event);
  score_backtrack(step.navigation.backtracks);
  if (options_.progress)
    options_.progress(share_done(recorder_.record(), mission_, step.navigation.estimate));
  return step;
}

void SimulatedRobot::begin_record() {
  const std::vector<TruePose>& track = simulation_.scorer().track();
  const Pose2 start = track.empty() ? site_.start : track.back().map_from_base;
  simulation_.scorer().forget();
  scores_.clear();
  recorder_.begin(mission_.goals(), start);
}

RunRecord SimulatedRobot::end_record() {
  const Scorer& scorer = simulation_.scorer();
  RunRecord record{recorder_.end(mission_)};
  record.scores = std::move(scores_);
  record.truth = scorer.track();
  record.path_distances_m = scorer.path_distances_m();
  record.contacts = scorer.contacts();
  record.contact_score = scorer.contact_score();
  record.faults = simulation_.faults();
  return record;
}

/// Reports a goal's outcome to the scorer, and records its score.
void SimulatedRobot::score(MissionEvent event) {
  Scorer& scorer = simulation_.scorer();
  if (event == MissionEvent::path_planned) scorer.claim_path(mission_.path());
  if (event != MissionEvent::goal_arrived) return;
  const std::size_t ended = mission_.current() - 1;
  const Goal& goal = mission_.goals().at(ended);
  scorer.claim_arrival(goal.position_m, goal.heading_rad);
  scores_.resize(ended);  // goals before it that did not arrive have none
  scores_.emplace_back(scorer.arrivals().back());
}

/// Keeps only the sums of what is not recorded.
void SimulatedRobot::forget() {
  Scorer& scorer = simulation_.scorer();
  for (const TruePose& at : scorer.track()) {
    if (last_ && at.stamp <= last_->stamp) continue;
    if (last_) unrecorded_.driven_m += (at.map_from_base.position_m - last_->map_from_base.position_m).norm();
    last_ = at;
  }
  const ContactScore score = scorer.contact_score();
  unrecorded_.contacts += scorer.contacts();
  unrecorded_.touches += score.moving + score.excused;
  unrecorded_.driven += control_period;
  scorer.forget();
}

/// While it backtracks, the track is not scored against the path.
void SimulatedRobot::score_backtrack(bool goes_back) {
  if (goes_back) simulation_.scorer().claim_path({});
  if (!goes_back && went_back_) simulation_.scorer().claim_path(mission_.path());
  went_back_ = goes_back;
}

/// Of an estimate that was made just now.
std::optional<TrueError> SimulatedRobot::error_of(const NavigationStep& step) {
  if (!step.estimate) return std::nullopt;
  const std::vector<TruePose>& track = simulation_.scorer().track();
  RunRecord moment;
  moment.steps.push_back({.estimate = *step.estimate, .commanded = {}, .measured = {}});
  moment.truth.assign(track.end() - std::min<std::ptrdiff_t>(10, std::ssize(track)), track.end());
  const std::vector<EstimateError> errors = estimate_errors(moment);
  if (errors.empty()) return std::nullopt;
  return TrueError{errors.front().position_m, errors.front().heading_rad};
}

Pace::Pace() : next_(monotonic_now()) {}

void Pace::keep() {
  next_ = std::max(next_ + SimulatedRobot::control_period, monotonic_now());
  sleep_until(next_);
}

}  // namespace lodestar
