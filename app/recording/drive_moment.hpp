#pragma once

#include <functional>
#include <string>

#include "app/navigation/mission.hpp"
#include "app/recording/drive_record.hpp"
#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// One step of a drive, for observers.
struct DriveMoment {
  const SensorInput& input;
  const MissionStep& step;
  const Mission& mission;
  std::optional<KeptPicture> picture;  ///< that the record keeps of this step, if any
};

/// Callbacks during a recorded drive, from the thread of the control loop, which they must not delay.
struct DriveWatcher {
  std::function<void(const DriveMoment&)> step;           ///< after each step, once its command has been sent
  std::function<void(const StampedCanFrame&)> can_frame;  ///< each frame on the base's bus
};

/// The event of the present goal in words; empty for none.
std::string in_words(const Mission& mission, MissionEvent event);

/// The base's state, and its fault in brackets, with its details if they are given.
std::string in_words(BaseState state, const std::optional<BaseFault>& fault, const std::string& details = {});

}  // namespace lodestar
