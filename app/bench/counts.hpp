#pragma once

#include <cstdint>

#include "app/bench/method.hpp"
#include "app/bench/reliability.hpp"

// How often markers are read right, and whether anything is ever read wrongly, counted over many hard frames.
namespace lodestar {

struct FrameCounts {
  int frames = 0;
  int markers = 0;  ///< wholly in view and not hidden, over all frames
  int right = 0;    ///< readings
  int wrong = 0;    ///< readings of what is not there
  int frames_with_wrong = 0;
  std::vector<StatedOutcome> stated;  ///< of all readings that come with a probability
};

enum class HardFrames {
  /// Several markers with any IDs, in light from good to poor, blurred or sharp, among tubes, lamps, glints
  /// and patches of sun, from 1.5 to 4 m, tilted by up to 10 degrees; half of them with a sheet over
  /// something.
  adverse,
  /// The same without any marker.
  empty,
  /// One marker of which O, X or Y is hidden wholly or in part, or cut by the border of the picture.
  direction_dot_lost,
};

/// Counts in all cores; the counts depend on nothing but the seed. `done` hears of frames done, from any
/// thread.
FrameCounts count_frames(HardFrames kind, const MethodChoice& choice, int frames, std::uint64_t seed,
                         const std::function<void(int frames)>& done);

}  // namespace lodestar
