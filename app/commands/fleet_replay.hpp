#pragma once

#include "app/commands/fleet_service.hpp"
#include "app/common/command.hpp"
#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

/// Drives a simulated robot by a fleet manager's orders, in real time, until Ctrl-C. Exit 1 where it touched
/// anything.
ExitCode replay_in_fleet(const Site& site, SimulatedDriveOptions options, const FleetArguments& arguments);

}  // namespace lodestar
