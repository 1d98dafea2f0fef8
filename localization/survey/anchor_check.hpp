#pragma once

#include <optional>
#include <vector>

#include "localization/survey/survey_bundle.hpp"

// What people measured, against each other and against the drive.
namespace lodestar {

/// Anchors must not cost more than their number explains: `cost` is what they add to the squared residuals.
std::optional<SurveyRefusal> false_anchor(const SurveyProblem& problem, const SurveyBundle& bundle,
                                          double cost);

/// Writes into the survey which errors of anchors and print would have been noticed.
void check_anchors(const SurveyProblem& problem, const SurveyBundle& bundle,
                   const std::vector<double>& redundancies, MarkerSurvey& survey);

}  // namespace lodestar
