#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/site/site.hpp"
#include "localization/survey/marker_survey.hpp"
#include "localization/survey/survey_difference.hpp"

// A survey for people and files.
namespace lodestar {

/// The robot as its file has it.
SurveyBelief survey_belief_of(const Robot& robot);

/// What was found, what it is known to, and what is not known at all.
std::string text_report(const MarkerSurvey& survey);
nlohmann::ordered_json json_report(const MarkerSurvey& survey);

/// Why the survey cannot be used and what to do, one line per flaw; empty when it can.
std::vector<std::string> complaints(const MarkerSurvey& survey);

/// The surveyed registry. In a frame of its own where no anchor holds it.
MarkerRegistry registry_of(const MarkerSurvey& survey);

/// Where a registry comes from: `format: lodestar-survey`, with logs, date, residuals, links and each
/// marker's covariance of (x, y, yaw).
std::string provenance_yaml(const MarkerSurvey& survey, std::span<const SurveyLog> logs,
                            const std::filesystem::path& anchors, const std::string& date);

/// The joint covariance of (x_m, y_m, yaw_rad) of all markers as a NumPy file (version 1.0, float64, C
/// order).
std::string covariance_npy(const Eigen::MatrixXd& covariance);

/// Proposals as the table `id,change,dx_m,dy_m,dyaw_deg,sigma_xy_m,sigma_yaw_deg`.
std::string csv_report(const SurveyDifference& difference);
std::string text_report(const SurveyDifference& difference);
nlohmann::ordered_json json_report(const SurveyDifference& difference);

/// The registry with all proposals applied: moved and swapped markers at their new places, new ones added,
/// gone ones left out.
MarkerRegistry with_proposals(MarkerRegistry registry, const SurveyDifference& difference);

}  // namespace lodestar
