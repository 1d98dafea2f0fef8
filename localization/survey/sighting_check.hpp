#pragma once

#include <optional>

#include "localization/survey/marker_survey.hpp"
#include "localization/survey/survey_start.hpp"

namespace lodestar {

/// Finds an ID that is read at two places: its sightings, as the start has the robot's poses, lie apart by
/// more than any survey is off. Nothing when all agree.
std::optional<SurveyRefusal> check_sightings(const SurveyKeyframes& keyframes, const SurveyStart& start);

}  // namespace lodestar
