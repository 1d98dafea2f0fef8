#include "app/simulate/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "app/simulate/simulated_drive.hpp"

namespace lodestar {
namespace {

/// At rest: over so many records, 0.2 s, nothing has moved by more than at 1 cm/s.
constexpr std::size_t rest_records = 10;
constexpr double rest_m = 0.002;

bool rests(const std::vector<TruePose>& track, double outer_radius_m) {
  if (track.size() <= rest_records) return false;
  const Pose2& now = track.back().map_from_base;
  const Pose2& before = track[track.size() - 1 - rest_records].map_from_base;
  return (now.position_m - before.position_m).norm() <= rest_m &&
         std::abs(wrap_angle(now.yaw_rad - before.yaw_rad)) * outer_radius_m <= rest_m;
}

double from_goal_m(const Scenario& scenario, const TruePose& truth) {
  return (truth.map_from_base.position_m - scenario.site.goals.front().position_m).norm();
}

double length_m(const std::vector<TruePose>& track) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < track.size(); ++i)
    sum_m += (track[i].map_from_base.position_m - track[i - 1].map_from_base.position_m).norm();
  return sum_m;
}

SimulatedDriveOptions drive_options(const Scenario& scenario, std::uint64_t seed) {
  SimulatedDriveOptions options{.camera = scenario.site.default_camera,
                                .seed = seed,
                                .goals = scenario.site.goals,
                                .uncertainty_constraint = std::nullopt};
  options.scanner = scenario.scanner;
  options.discs = scenario.discs;
  options.overhangs = scenario.overhangs;
  options.is_placed_at_start = scenario.is_placed_at_start;
  return options;
}

std::string why_not_arrived(const Scenario& scenario, const RunRecord& record) {
  if (record.truth.empty() || record.goals.empty()) return "interrupted";
  if (seconds(record.truth.back().stamp) >= scenario.time_limit_s) return "time limit";
  const GoalRecord& goal = record.goals.front();
  if (goal.arrived)
    return fmt::format("arrival reported {:.3f} m from the goal", from_goal_m(scenario, record.truth.back()));
  return goal.failure.empty() ? "interrupted" : goal.failure;
}

}  // namespace

ScenarioRun run_scenario(const Scenario& scenario, std::uint64_t seed, const std::function<bool()>& goes_on) {
  const Robot& robot = scenario.site.robot;
  const double outer_radius_m = robot.footprint ? robot.footprint->outer_radius_m() : robot.radius_m;
  SimulatedDriveOptions options = drive_options(scenario, seed);
  options.goes_on = goes_on;
  options.is_over = [&](const Scorer& scorer) {
    const std::vector<TruePose>& track = scorer.track();
    if (track.empty()) return false;
    if (seconds(track.back().stamp) >= scenario.time_limit_s) return true;
    return from_goal_m(scenario, track.back()) <= scenario.goal_radius_m && rests(track, outer_radius_m);
  };
  RunRecord record = simulate_drive(scenario.site, options);

  const bool is_at_goal =
      !record.truth.empty() && from_goal_m(scenario, record.truth.back()) <= scenario.goal_radius_m;
  const bool was_in_time =
      !record.truth.empty() && seconds(record.truth.back().stamp) < scenario.time_limit_s;
  const bool has_reported = !record.goals.empty() && record.goals.front().arrived;
  const bool arrived = was_in_time && is_at_goal && (has_reported || rests(record.truth, outer_radius_m));
  ScenarioRun run;
  run.seed = seed;
  run.contacts = record.contact_score;
  run.success = arrived && run.contacts.moving == 0;
  run.time_s = record.truth.empty() ? 0.0 : seconds(record.truth.back().stamp);
  run.length_m = length_m(record.truth);
  run.reason = run.success ? "arrived" : arrived ? "contact while moving" : why_not_arrived(scenario, record);
  run.track = std::move(record.truth);
  return run;
}

}  // namespace lodestar
