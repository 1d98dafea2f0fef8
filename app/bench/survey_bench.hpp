#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/bench/survey_fixes.hpp"

namespace lodestar {

/// A kind of site and tour.
struct SurveyScenario {
  std::string name;
  double width_m = 15.0;
  double depth_m = 7.5;
  double pitch_m = 2.2;  ///< of the markers
  std::vector<Vec2> way_m;
  int anchors = 0;  ///< markers at the corners, known to 3 mm
};
std::vector<SurveyScenario> survey_scenarios();

/// One seed of a scenario.
struct SurveyTrial {
  bool refused = false;
  std::string why;
  SurveyErrors errors;
  double length_m = 0.0;
  std::size_t markers = 0;
  std::size_t keyframes = 0;
  double solve_s = 0.0;  ///< wall time, covariance included
  FixErrors fixes;
};
/// The print's scale is drawn with a sigma of 1e-4, to which the survey knows it.
SurveyTrial try_survey(const SurveyScenario& scenario, std::uint64_t seed);

/// What is wrong with a log and nobody says.
enum class Spoiling { swapped_id, clock_shift, slip, lens, moved_anchor, print_scale };
std::string to_string(Spoiling spoiling);
std::vector<Spoiling> all_spoilings();

/// A lab tour with four corner markers as anchors, spoiled.
struct SpoiledTrial {
  bool refused = false;
  std::string why;
  double nees = 0.0;
  int freedom = 0;
  /// What was spoiled is smaller than what the survey's report says would have been noticed.
  bool is_said_unnoticeable = false;
  /// Less likely than 1e-6, and written all the same.
  [[nodiscard]] bool is_wrong() const;
  /// And the report does not say that this might be so.
  [[nodiscard]] bool is_silently_wrong() const { return is_wrong() && !is_said_unnoticeable; }
};
SpoiledTrial try_spoiled(Spoiling spoiling, std::uint64_t seed);

}  // namespace lodestar
