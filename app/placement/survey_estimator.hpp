#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/site/site.hpp"
#include "localization/survey/survey_difference.hpp"
#include "localization/survey/weakest_links.hpp"

namespace lodestar {

/// Where a person has put the robot at the beginning, and how exactly.
struct PlacedStart {
  Pose2 map_from_base;
  double sigma_m = 0.01;
  double sigma_rad = radians(0.2);
};

struct SurveyEstimatorOptions {
  double target_sigma_m = 0.002;     ///< of a marker, to aim at
  std::optional<PlacedStart> start;  ///< holds the registry on the map
};

/// A survey while it is driven.
struct SurveyProgress {
  std::uint64_t number = 0;  ///< 1, 2, ... estimates so far
  std::size_t frames = 0;    ///< with markers, so far
  MarkerSurvey survey;       ///< its flaws say what is missing
  /// By the start, where that is known; else by registered markers; else as if it had begun at the site's
  /// start.
  Pose2 map_from_survey;
  bool is_on_map = false;                      ///< by one of the first two
  std::optional<SurveyDifference> difference;  ///< against the site's registry
  std::vector<MarkerLink> links;               ///< the weakest first: drive there next
  double target_sigma_m = 0.0;
};

/// Those that a link above the target ties to a neighbour, ascending.
std::vector<int> markers_above_target(const SurveyProgress& progress);

/// Collects what a survey is made of, and estimates the registry from all of it at any time.
class SurveyEstimator {
 public:
  SurveyEstimator(const Site& site, const std::string& camera, const SurveyEstimatorOptions& options = {});

  void add(SurveyFrame frame);
  void add(const WheelTravel& reading) { log_.wheels.push_back(reading); }
  void add(const VisualOdometryIncrement& motion) { log_.ceiling.push_back(motion); }
  [[nodiscard]] bool has_frames() const { return !log_.frames.empty(); }

  [[nodiscard]] SurveyProgress estimate();

 private:
  [[nodiscard]] Anchors anchors() const;

  SurveyEstimatorOptions options_;
  CameraModel camera_;
  SurveyBelief belief_;
  MarkerRegistry registry_;
  Pose2 start_;
  SurveyLog log_;
  std::uint64_t estimates_ = 0;
};

/// The markers of a survey under way as a registry on the map, each with its sigma.
MarkerRegistry registry_so_far(const SurveyProgress& progress);

}  // namespace lodestar
