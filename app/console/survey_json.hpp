#pragma once

#include <nlohmann/json.hpp>

#include "app/placement/live_survey.hpp"

namespace lodestar {

/// A survey under way for the page, in the map's frame: {"type": "survey", number, frames, on_map, target_m,
/// markers: [{id, x_m, y_m, yaw_deg, sigma_m, covariance_m2: [xx, xy, yy], places}], links: [[id, id,
/// places]], path: [[x_m, y_m]], flaws: [{flaw, found}], rare: [id], unseen: [id], next: {x_m, y_m, ids,
/// sigma_m} or null, proposals: [{id, change, x_m, y_m, yaw_deg, dx_m, dy_m, dyaw_deg, sigma_m}]}.
nlohmann::ordered_json survey_json(const SurveyProgress& progress, const MarkerRegistry& registry);

}  // namespace lodestar
