#include "app/commands/conducted_replay.hpp"

#include <fmt/core.h>

#include "app/common/interruption.hpp"

namespace lodestar {
namespace {

ExitCode replay_conducted(const Site& site, SimulatedDriveOptions options,
                          const std::function<void(const MissionStep&, Mission&)>& conduct) {
  options.goals.clear();
  options.realtime = true;
  const Interruption interruption;
  const ConductedDrive driven =
      simulate_conducted_drive(site, options, [&](const MissionStep& step, Mission& mission) {
        conduct(step, mission);
        return !Interruption::asked();
      });
  fmt::print("{:.1f} m driven, {} contacts\n", driven.driven_m, driven.touches);
  return driven.touches == 0 ? done : job_failed;
}

}  // namespace

ExitCode replay_in_fleet(const Site& site, SimulatedDriveOptions options, const FleetArguments& arguments) {
  FleetService fleet(site, fleet_settings(site, arguments, true));
  options.on_input = [&fleet](const SensorInput& input) { fleet.session().hear(input); };
  return replay_conducted(site, std::move(options), [&fleet](const MissionStep& step, Mission& mission) {
    fleet.session().attend(step, mission);
  });
}

ExitCode replay_waiting(const Site& site, SimulatedDriveOptions options) {
  return replay_conducted(site, std::move(options), [](const MissionStep&, Mission&) {});
}

}  // namespace lodestar
