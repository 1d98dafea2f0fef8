#pragma once

#include <span>
#include <vector>

#include "localization/survey/keyframes.hpp"
#include "localization/survey/marker_survey.hpp"
#include "maps/anchors.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// An anchor whose log and keyframe have been found.
struct PlacedAnchor {
  std::size_t anchor = 0;    ///< index of Anchors::anchors
  std::size_t keyframe = 0;  ///< of a robot's
  Pose2 keyframe_from_robot;
};

/// Stamps at which the robot was measured: a keyframe must be near.
std::vector<KeptStamp> kept_stamps(const Anchors& anchors, std::span<const SurveyLog> logs);

/// Anchors by their keyframes; appends what is wrong with those that have none.
std::vector<PlacedAnchor> place_anchors(const Anchors& anchors, std::span<const SurveyLog> logs,
                                        const SurveyKeyframes& keyframes, double track_width_m,
                                        std::vector<SurveyRefusal>& flaws);

}  // namespace lodestar
