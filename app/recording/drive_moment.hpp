#pragma once

#include <functional>
#include <string>

#include "app/navigation/mission.hpp"
#include "app/recording/drive_record.hpp"

namespace lodestar {

/// One step of a drive, for observers.
struct DriveMoment {
  const SensorInput& input;
  const MissionStep& step;
  const Mission& mission;
  std::optional<KeptPicture> picture;  ///< that the record keeps of this step, if any
};

/// Called after each step, once its command has been sent.
using DriveWatcher = std::function<void(const DriveMoment&)>;

/// The event of the present goal in words; empty for none.
std::string in_words(const Mission& mission, MissionEvent event);

}  // namespace lodestar
