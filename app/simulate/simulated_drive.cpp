#include "app/simulate/simulated_drive.hpp"

#include "app/live/operator_session.hpp"
#include "app/simulate/simulated_robot.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

RunRecord simulate_drive(const Site& site, const SimulatedDriveOptions& options) {
  SimulatedRobot robot(site, options);
  Pace pace;
  robot.begin_record();
  while (!robot.mission().finished() || (options.stays_on && options.stays_on())) {
    robot.step();
    if (options.goes_on && !options.goes_on()) break;
    if (options.is_over && options.is_over(robot.scorer())) break;
    if (options.realtime) pace.keep();
  }
  return robot.end_record();
}

ConductedDrive simulate_conducted_drive(const Site& site, const SimulatedDriveOptions& options,
                                        const std::function<bool(const MissionStep&, Mission&)>& conduct) {
  SimulatedRobot robot(site, options);
  Pace pace;
  while (conduct(robot.step(), robot.mission())) {
    if (options.goes_on && !options.goes_on()) break;
    if (options.realtime) pace.keep();
  }
  return robot.unrecorded();
}

void simulate_attended_drive(const Site& site, const SimulatedDriveOptions& options, OperatorSession& session,
                             const std::function<bool()>& goes_on,
                             const std::function<void(RunRecord)>& keep) {
  SimulatedRobot robot(site, options);
  Pace pace;
  while (goes_on()) {
    session.apply_orders(robot.mission(), robot.base(), robot.now(), monotonic_now());
    if (!robot.mission().finished() && !robot.recording()) robot.begin_record();
    robot.step(&session);
    const bool has_ended = robot.recording() && robot.mission().finished();
    if (has_ended) keep(robot.end_record());
    const bool waits_for_people = robot.mission().finished() || robot.mission().paused();
    if (options.realtime || waits_for_people) pace.keep();
  }
  if (robot.recording()) keep(robot.end_record());
}

}  // namespace lodestar
