#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/site/site.hpp"
#include "localization/calibration/mount_calibration.hpp"
#include "localization/calibration/time_offset.hpp"
#include "localization/survey/survey_log.hpp"

namespace lodestar {

/// The frames of a log in which registered markers were seen.
struct MountSet {
  std::size_t images = 0;  ///< in all
  std::vector<MountFrame> frames;
  std::optional<TimeOffset>
      time_offset;  ///< of the images' stamps against the wheels'; nothing: not observable
};

/// The poses of a log's frames. Frames that are clearly stamped too late or too early are paired with the
/// wheels' travel at their exposure.
MountSet mount_set_of(const SurveyLog& log, const MarkerRegistry& registry, const CameraModel& camera,
                      const Robot& robot);

/// The mount as the robot file has it.
MountBelief belief_of(const Robot& robot);

/// The result as text and as JSON.
std::string text_report(const MountSet& set, const MountCalibration& calibration);
nlohmann::ordered_json json_report(const MountSet& set, const MountCalibration& calibration);

/// Why the log cannot be used, one line per flaw; empty when it can.
std::vector<std::string> complaints(const MountSet& set, const MountCalibration& calibration,
                                    const MountCalibrationOptions& options);

/// The measured keys of `camera_mount`, formatted for the robot file.
std::map<std::string, std::string> measured_keys(const MountEstimate& estimate);

}  // namespace lodestar
