#include "localization/survey/pieces.hpp"

#include <algorithm>

#include "localization/detection/disjoint_sets.hpp"

namespace lodestar {

SurveyPieces pieces_of(const SurveyKeyframes& keyframes) {
  const std::size_t frames = keyframes.frames.size();
  DisjointSets sets(frames + keyframes.ids.size());
  for (std::size_t i = 0; i < frames; ++i) {
    if (keyframes.frames[i].from_previous) sets.join(i - 1, i);
    for (const KeyframeSighting& sighting : keyframes.frames[i].sightings)
      sets.join(i, frames + sighting.marker);
  }
  SurveyPieces pieces;
  sets.number(pieces.of_keyframe);
  pieces.of_keyframe.resize(frames);
  if (frames > 0) pieces.count = 1 + *std::ranges::max_element(pieces.of_keyframe);
  return pieces;
}

}  // namespace lodestar
