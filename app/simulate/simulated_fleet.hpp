#pragma once

#include <functional>
#include <vector>

#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

/// One robot of a fleet that is simulated in one world.
struct FleetRobot {
  Pose2 start;
  std::function<void(const SensorInput&)> on_input;
  std::function<void(const MissionStep&, Mission&)> conduct;  ///< called after each step
};

/// Drives robots in one world, step by step in turn, in real time until `goes_on` returns false: each has its
/// own sensors, base and navigator, and is a disc to the others, which touches and is seen by scanners. They
/// do not push each other. `options` hold for each, with seeds one after another. Returns what each drove.
std::vector<ConductedDrive> simulate_fleet(const Site& site, const SimulatedDriveOptions& options,
                                           const std::vector<FleetRobot>& robots,
                                           const std::function<bool()>& goes_on);

}  // namespace lodestar
