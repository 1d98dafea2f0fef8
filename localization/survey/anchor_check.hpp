#pragma once

#include <optional>
#include <vector>

#include "localization/survey/survey_bundle.hpp"

// What people measured, against each other and against the drive.
namespace lodestar {

/// Whether an anchor gives the registry a place on the map; distances give it a size only.
bool holds(const Anchors& anchors);

/// What anchors add to the squared residuals, and what they may on average: their numbers less those that
/// only place and turn the registry.
SurveyFit fit_of_anchors(const SurveyProblem& problem, const SurveyBundle& bundle, double chi2_without);

/// Refuses what is less likely than SurveyOptions::least_probability, and names the farthest anchor.
std::optional<SurveyRefusal> false_anchor(const SurveyProblem& problem, const SurveyBundle& bundle,
                                          const SurveyFit& fit);

/// Writes into the survey which errors of anchors and print would have been noticed.
void check_anchors(const SurveyProblem& problem, const SurveyBundle& bundle,
                   const std::vector<double>& redundancies, MarkerSurvey& survey);

}  // namespace lodestar
