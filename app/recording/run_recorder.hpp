#pragma once

#include "app/navigation/mission.hpp"
#include "app/recording/drive_record.hpp"

// Adds the steps and events of a drive to its record, in simulation and on the real robot.
namespace lodestar {

void record_step(DriveRecord& record, const SensorInput& input, const NavigationStep& step);

/// Records how the present goal was planned, or ended.
void record_event(DriveRecord& record, const Mission& mission, MissionEvent event, Stamp now);

}  // namespace lodestar
