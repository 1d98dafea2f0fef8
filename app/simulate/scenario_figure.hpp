#pragma once

#include <opencv2/core/mat.hpp>

#include "app/simulate/scenario.hpp"

namespace lodestar {

/// The map, the discs' ways as far as the drive lasted with a ring each second, and the driven track with a
/// ring of the robot's size each second; start, goal, and where the discs and the robot were at the end.
cv::Mat draw_scenario(const Scenario& scenario, const ScenarioRun& run);

}  // namespace lodestar
