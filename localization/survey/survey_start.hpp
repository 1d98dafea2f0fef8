#pragma once

#include <optional>
#include <vector>

#include "localization/survey/keyframes.hpp"

// A start for the survey's least squares from nothing but the logs. Dead reckoning alone is none: a row's
// turn may be off by so much that the bundle sticks in another minimum.
namespace lodestar {

struct SurveyStart {
  std::vector<Pose2> map_from_base;    ///< of each keyframe, the first at the origin
  std::vector<Pose2> map_from_marker;  ///< of each marker: dot O and the direction to X
  WheelGauge gauge;
  double wheel_scale = 1.0;  ///< metres per reported metre
  Vec2 mount_m = Vec2::Zero();
};

/// (a) Headings chained by wheels and by markers while they stay in view, without closing loops: from them
/// come the whole turns. (b) All headings with all loops by one linear least squares, the wheels' scales
/// unknown. (c) All positions by another. Sightings far from the others count less (Cauchy weights). Nothing
/// when an equation cannot be solved. All keyframes must hang together.
std::optional<SurveyStart> start_survey(const SurveyKeyframes& keyframes, const SurveyBelief& belief,
                                        const SurveyOptions& options);

}  // namespace lodestar
