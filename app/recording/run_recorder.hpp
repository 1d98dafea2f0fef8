#pragma once

#include "app/navigation/mission.hpp"
#include "app/recording/drive_record.hpp"

// What a drive adds to its record, step by step, in simulation as in the real world.
namespace lodestar {

void record_step(DriveRecord& record, const SensorInput& input, const NavigationStep& step);

/// What has come of the present goal.
void record_event(DriveRecord& record, const Mission& mission, MissionEvent event, Stamp now);

}  // namespace lodestar
