#include "app/recording/run_recorder.hpp"

#include <algorithm>

namespace lodestar {
namespace {

/// The navigator's present problem, if any.
NoticeRecord notice_of(const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault && input.base.fault)
    return {input.now, std::string(to_string(*input.base.fault)), true};
  if (step.stop) return {input.now, std::string(to_string(*step.stop)), true};
  if (step.camera) return {input.now, std::string(to_string(*step.camera)), false};
  return {input.now, {}, false};
}

}  // namespace

bool DriveRecord::arrived() const {
  return std::ranges::all_of(goals, &GoalRecord::arrived);
}

void record_step(DriveRecord& record, const SensorInput& input, const NavigationStep& step) {
  record.frames += static_cast<int>(input.frames.size());
  for (const FixAttempt& used : step.fixes) {
    const bool accepted =
        used.outcome != FixOutcome::refused_gate && used.outcome != FixOutcome::refused_late;
    record.fixes.push_back({.stamp = used.fix.stamp,
                            .map_from_base = used.planar.map_from_base,
                            .ids = used.fix.ids,
                            .confidence = used.fix.confidence,
                            .accepted = accepted});
  }
  record.distrusted = step.distrusted;
  const NoticeRecord notice = notice_of(input, step);
  const std::string& last = record.notices.empty() ? std::string() : record.notices.back().words;
  if (notice.words != last) record.notices.push_back(notice);
  if (!step.estimate) return;
  record.steps.push_back({.estimate = *step.estimate,
                          .commanded = step.command,
                          .measured = input.base.measured.value_or(BodyVelocity{}),
                          .wheel_scales = step.wheel_scales});
}

void record_event(DriveRecord& record, const Mission& mission, MissionEvent event, Stamp now) {
  if (event == MissionEvent::none) return;
  if (event == MissionEvent::path_planned) {
    GoalRecord& goal = record.goals.at(mission.current());
    const bool is_first = goal.planned.waypoints_m.empty();
    goal.planned = mission.path();
    if (!is_first) return;
    goal.travel_time = -now.time_since_epoch();
    goal.ideal_s = mission.ideal_s();
    return;
  }
  GoalRecord& goal = record.goals.at(mission.current() - 1);
  if (!goal.planned.waypoints_m.empty()) goal.travel_time += now.time_since_epoch();
  goal.ended = now;
  goal.arrived = event == MissionEvent::goal_arrived;
  if (!goal.arrived) goal.failure = mission.failure();
}

}  // namespace lodestar
