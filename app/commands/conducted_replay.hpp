#pragma once

#include "app/commands/fleet_service.hpp"
#include "app/common/command.hpp"
#include "app/simulate/simulated_drive.hpp"

// A simulated robot in real time that drives by what others ask for, until Ctrl-C. Exit 1 where it touched
// anything.
namespace lodestar {

/// By a fleet manager's orders.
ExitCode replay_in_fleet(const Site& site, SimulatedDriveOptions options, const FleetArguments& arguments);

/// By what takes part after each step, as `options` say.
ExitCode replay_waiting(const Site& site, SimulatedDriveOptions options);

}  // namespace lodestar
