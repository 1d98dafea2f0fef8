#pragma once

#include <string>

#include "localization/survey/marker_survey.hpp"

namespace lodestar {

/// A survey as a self-contained page: a drawing of markers, the links between them and the robot's way, plots
/// of sigmas and residuals, and all markers as a table.
std::string survey_html(const MarkerSurvey& survey, const std::string& title);

}  // namespace lodestar
