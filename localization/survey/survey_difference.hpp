#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "localization/survey/marker_survey.hpp"

namespace lodestar {

enum class MarkerChange { moved, swapped, appeared, gone };

/// Name in results: `moved`, `swapped`, `new`, `gone`.
std::string_view to_string(MarkerChange change);

/// What a drive says of a marker against the registry. Offsets and sigmas are 0 for markers that are gone.
struct MarkerProposal {
  int id = 0;
  MarkerChange change = MarkerChange::moved;
  RegisteredMarker proposed;  ///< where it hangs, in the registry's frame
  Vec2 offset_m = Vec2::Zero();
  double turn_rad = 0.0;
  double sigma_m = 0.0;
  double sigma_rad = 0.0;
};

struct SurveyDifferenceOptions {
  double least_offset_m = 0.005;         ///< no smaller move is proposed, ...
  double least_turn_rad = radians(0.5);  ///< ... nor a smaller turn
  double sigmas = 5.0;                   ///< nor one that may be chance
  double registry_sigma_m = 0.002;       ///< of markers that do not say theirs
  double registry_sigma_rad = radians(0.2);
  double registry_scale_sigma = 0.001;  ///< of how long its metre is; the survey says of its own
  double swapped_within_m = 0.05;       ///< of the other's place
  int least_views = 5;                  ///< places from which a marker must have been seen if it hung there
  double view_margin_px = 25.0;
};

struct SurveyDifference {
  Pose2 registry_from_survey;  ///< by the markers that did not change, at their middle
  double scale = 1.0;          ///< the registry's distances over the survey's
  int unchanged = 0;
  std::vector<MarkerProposal> proposals;  ///< by ID
};

/// Compares a survey with what is registered: aligns them by the markers that agree, in place, turn and, as
/// far as neither knows it, scale, then judges each by its own sigmas without those. Nothing where fewer than
/// two markers agree: then it cannot be said which have moved.
std::optional<SurveyDifference> compare(const MarkerSurvey& survey, const MarkerRegistry& registry,
                                        const CameraModel& camera,
                                        const SurveyDifferenceOptions& options = {});

}  // namespace lodestar
