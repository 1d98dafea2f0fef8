#pragma once

#include <cstdint>

#include "app/bench/survey_world.hpp"

namespace lodestar {

/// Errors of the robot's position by single frames of a drive, root mean square.
struct FixErrors {
  int fixes = 0;             ///< with either registry
  int lost = 0;              ///< with the true one only
  double by_survey_m = 0.0;  ///< with the surveyed registry, laid best onto the true one
  double by_truth_m = 0.0;   ///< with true places and yaws
};

/// Frames of another drive along the same way.
FixErrors fix_errors(const SurveyWorld& world, const MarkerSurvey& survey, const std::vector<Vec2>& way_m,
                     std::uint64_t seed);

}  // namespace lodestar
