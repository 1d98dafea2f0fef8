#pragma once

#include <optional>
#include <span>
#include <vector>

#include "localization/survey/ceiling_track.hpp"
#include "localization/survey/survey_log.hpp"
#include "localization/survey/survey_options.hpp"
#include "localization/survey/wheel_segment.hpp"
#include "maps/camera_model.hpp"

namespace lodestar {

/// A marker seen from a keyframe, and where it is from there if the robot stands level: the start of all
/// estimates.
struct KeyframeSighting {
  std::size_t marker = 0;  ///< index in SurveyKeyframes::ids
  MarkerDots dots;
  Pose2 base_from_marker;
  double above_camera_m = 0.0;
};

/// A frame that takes part in the survey.
struct SurveyKeyframe {
  std::size_t log = 0;
  Stamp stamp;
  std::vector<KeyframeSighting> sightings;
  std::optional<WheelSegment> from_previous;  ///< nothing at a log's begin, and where readings are missing
  std::optional<CeilingSegment> by_ceiling;   ///< likewise, by the ceiling's texture
};

struct SurveyKeyframes {
  std::vector<int> ids;                ///< of all markers seen, ascending
  std::vector<SurveyKeyframe> frames;  ///< log by log, in order of time
};

/// Frames far enough apart, in all logs. `kept` are stamps (with their logs) near which a frame is kept in
/// any case. A marker that one frame shows and those beside it do not is left out of it: that is a
/// misreading.
struct KeptStamp {
  std::size_t log = 0;
  Stamp stamp;
};
SurveyKeyframes choose_keyframes(std::span<const SurveyLog> logs, std::span<const KeptStamp> kept,
                                 const CameraModel& camera, const SurveyBelief& belief,
                                 const SurveyOptions& options);

}  // namespace lodestar
