#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/bench/survey_fixes.hpp"

namespace lodestar {

/// What a scenario promises, over all its seeds. Issue 21 has the numbers; infinite: nothing is promised.
struct SurveyLimits {
  double most_rms_m = std::numeric_limits<double>::infinity();
  double most_shape_m = std::numeric_limits<double>::infinity();
  double most_over_bound = std::numeric_limits<double>::infinity();  ///< RMS over its bound
  double least_nees = 0.0;                                           ///< per degree of freedom
  double most_nees = std::numeric_limits<double>::infinity();
  double most_over_true_fix = std::numeric_limits<double>::infinity();
  double most_lost_fixes = 1.0;  ///< of those by the true registry
  double most_mount_m = std::numeric_limits<double>::infinity();
  double most_mount_rad = std::numeric_limits<double>::infinity();
  double most_solve_s = 10.0;
  double most_covariance_s = 15.0;
};

/// A kind of site and tour.
struct SurveyScenario {
  std::string name;
  double width_m = 15.0;
  double depth_m = 7.5;
  double pitch_m = 2.2;  ///< of the markers
  std::vector<Vec2> way_m;
  int anchors = 0;  ///< markers at the corners, known to 3 mm
  SurveyLimits limits = {};
};
std::vector<SurveyScenario> survey_scenarios();

/// One seed of a scenario.
struct SurveyTrial {
  bool refused = false;
  std::string why;
  SurveyErrors errors;
  double bound_m = 0.0;  ///< survey_bound_m()
  double length_m = 0.0;
  std::size_t markers = 0;
  std::size_t keyframes = 0;
  double solve_s = 0.0;       ///< wall time up to the registry
  double covariance_s = 0.0;  ///< and from there to the end
  double mount_off_m = 0.0;   ///< along the floor: the height is the robot file's
  double mount_off_rad = 0.0;
  FixErrors fixes;
};
/// The survey knows the print's scale to 1e-4; it is drawn with that sigma, or exactly 1.
SurveyTrial try_survey(const SurveyScenario& scenario, std::uint64_t seed, bool has_exact_print = false);

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
