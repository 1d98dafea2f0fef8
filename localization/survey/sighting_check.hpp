#pragma once

#include <optional>

#include "localization/survey/marker_survey.hpp"
#include "localization/survey/survey_start.hpp"

namespace lodestar {

/// Finds an ID that is read at two places: its sightings, as the start has the robot's poses, lie apart by
/// more than any survey is off. Few single frames of it are misreadings and are removed from `keyframes`.
/// Nothing when all agree.
struct SightingCheck {
  std::optional<SurveyRefusal> refusal;
  std::size_t removed = 0;
};
SightingCheck check_sightings(SurveyKeyframes& keyframes, const SurveyStart& start);

}  // namespace lodestar
