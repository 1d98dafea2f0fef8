#include "app/recording/run_recorder.hpp"

#include <algorithm>
#include <utility>

namespace lodestar {
namespace {

/// The navigator's present problem, if any.
NoticeRecord notice_of(const SensorInput& input, const NavigationStep& step) {
  if (input.base.state == BaseState::fault && input.base.fault)
    return {input.now, in_words(*input.base.fault, input.base.details), true};
  if (step.stop) return {input.now, std::string(to_string(*step.stop)), true};
  if (step.camera) return {input.now, std::string(to_string(*step.camera)), false};
  return {input.now, {}, false};
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

/// A goal whose way began where another was passed, on the same path.
void begin_after(const GoalRecord& passed, GoalRecord& next, Stamp now) {
  next.planned = passed.planned;
  next.ideal_s = passed.ideal_s;
  next.travel_time = -now.time_since_epoch();
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
  goal.arrived = event != MissionEvent::goal_failed;
  if (!goal.arrived) goal.failure = mission.failure();
  if (event == MissionEvent::goal_passed && !mission.finished())
    begin_after(goal, record.goals.at(mission.current()), now);
}

}  // namespace

bool DriveRecord::arrived() const {
  return std::ranges::all_of(goals, &GoalRecord::arrived);
}

RunRecorder::RunRecorder(const Site& site, RunRecorderOptions options)
    : site_(site),
      options_(std::move(options)),
      pictures_({.pictures_hz = options_.pictures_hz, .can_wait = options_.pictures_wait}) {}

void RunRecorder::begin(const std::vector<Goal>& goals, const Pose2& start) {
  is_on_ = true;
  watch_ = {};
  record_ = {};
  record_.site = site_.name;
  record_.camera = options_.camera;
  record_.seed = options_.seed;
  record_.start = start;
  record_.robot_radius_m = site_.robot.radius_m;
  for (const Goal& goal : goals) record_.goals.push_back({.goal = goal});
}

void RunRecorder::take(const StampedCanFrame& frame) {
  if (is_on_ && options_.watch.can_frame) options_.watch.can_frame(frame);
}

void RunRecorder::take(const SensorInput& input, const MissionStep& step, const Mission& mission) {
  if (!is_on_) return;
  record_step(record_, input, step.navigation);
  const std::optional<KeptPicture> picture = pictures_.keep(record_, input.frames);
  for (std::size_t i = record_.goals.size(); i < mission.goals().size(); ++i)
    record_.goals.push_back({.goal = mission.goals()[i]});
  record_event(record_, mission, step.event, input.now);
  if (options_.watch.step)
    options_.watch.step({.input = input, .step = step, .mission = mission, .picture = picture});
}

DriveRecord RunRecorder::end(const Mission& mission) {
  if (!is_on_) return {};
  is_on_ = false;
  if (!mission.finished()) record_.goals[mission.current()].failure = "stopped by the operator";
  record_.learned = mission.learned();
  record_.wall_time_s = watch_.seconds();
  return std::exchange(record_, {});
}

}  // namespace lodestar
