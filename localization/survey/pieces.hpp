#pragma once

#include <cstddef>
#include <vector>

#include "localization/survey/keyframes.hpp"

namespace lodestar {

/// Keyframes that hang together, by wheels or by markers seen from several: how many such pieces there are,
/// and which each keyframe belongs to.
struct SurveyPieces {
  std::size_t count = 0;
  std::vector<std::size_t> of_keyframe;
};
SurveyPieces pieces_of(const SurveyKeyframes& keyframes);

}  // namespace lodestar
