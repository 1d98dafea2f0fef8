#pragma once

#include <string>
#include <vector>

#include "localization/ceiling/visual_odometry_increment.hpp"
#include "localization/detection/detected_marker.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// The dots of one decoded marker in one frame, in pixels of the camera that the survey is given.
struct SightedMarker {
  int id = 0;
  MarkerDots dots;
};

struct SurveyFrame {
  Stamp stamp;  ///< the middle of the exposure
  std::vector<SightedMarker> markers;
};

/// The markers of which O, X and Y were seen, as a detector gives them.
std::vector<DetectedMarker> whole_markers(const SurveyFrame& frame);

/// What a survey takes of one drive: frames and wheel readings in order of time, on one clock.
struct SurveyLog {
  std::string name;
  std::vector<SurveyFrame> frames;
  std::vector<WheelTravel> wheels;
  std::vector<VisualOdometryIncrement> ceiling;  ///< the ceiling's own motion; may be empty
};

}  // namespace lodestar
