#pragma once

#include <vector>

#include "localization/survey/keyframes.hpp"

namespace lodestar {

/// Headings without loop closures, and with them the whole turns of every sighting.
struct HeadingChain {
  std::vector<double> heading_rad;  ///< of each keyframe, not wrapped
  /// Of each keyframe's sightings: the marker's yaw, as it was first seen in the chain, less the keyframe's
  /// heading, not wrapped.
  std::vector<std::vector<double>> yaw_less_heading;
};

/// A marker that stays in view carries the heading on; one that comes back is placed anew, as what the
/// heading has drifted by is not known yet. All keyframes must hang together.
HeadingChain chain_headings(const SurveyKeyframes& keyframes, double track_width_m);

}  // namespace lodestar
