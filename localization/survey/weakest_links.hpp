#pragma once

#include <vector>

#include "localization/survey/marker_survey.hpp"

namespace lodestar {

/// Two neighbouring markers, and how well their places relative to each other are known.
struct MarkerLink {
  int first = 0;
  int second = 0;
  double sigma_m = 0.0;           ///< of the one as seen from the other, along its worst direction
  Vec2 between_m = Vec2::Zero();  ///< in the survey's frame: a drive across here says most
};

/// The links of each marker to its four nearest, the weakest first. A lane across a weak one ties together
/// rows that were driven one after the other, which no anchor does as well.
std::vector<MarkerLink> weakest_links(const MarkerSurvey& survey);

}  // namespace lodestar
