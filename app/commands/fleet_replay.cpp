#include "app/commands/fleet_replay.hpp"

#include <fmt/core.h>

#include "app/common/interruption.hpp"

namespace lodestar {

ExitCode replay_in_fleet(const Site& site, SimulatedDriveOptions options, const FleetArguments& arguments) {
  FleetService fleet(site, fleet_settings(site, arguments, true));
  options.goals.clear();
  options.realtime = true;
  options.on_input = [&fleet](const SensorInput& input) { fleet.session().hear(input); };
  const Interruption interruption;
  const ConductedDrive driven =
      simulate_conducted_drive(site, options, [&fleet](const MissionStep& step, Mission& mission) {
        fleet.session().attend(step, mission);
        return !Interruption::asked();
      });
  fmt::print("{:.1f} m driven, {} contacts\n", driven.driven_m, driven.touches);
  return driven.touches == 0 ? done : job_failed;
}

}  // namespace lodestar
