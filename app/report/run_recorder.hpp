#pragma once

#include "app/mission.hpp"
#include "app/report/run_record.hpp"

// What a drive adds to its record, step by step, in simulation as in the real world.
namespace lodestar {

void record_step(RunRecord& record, const SensorInput& input, const NavigationStep& step);

/// What has come of the present goal.
void record_event(RunRecord& record, const Mission& mission, MissionEvent event, Stamp now);

}  // namespace lodestar
