#pragma once

#include <cstdint>

#include "app/bench/method.hpp"
#include "app/bench/reliability.hpp"

// Correct and wrong readings of markers, counted over many hard frames.
namespace lodestar {

struct FrameCounts {
  int frames = 0;
  int markers = 0;  ///< fully in view and not occluded, over all frames
  int right = 0;    ///< readings
  int wrong = 0;    ///< readings without a true marker
  int frames_with_wrong = 0;
  std::vector<StatedOutcome> stated;  ///< of all readings with a stated probability
};

enum class HardFrames {
  /// Several markers with any IDs, in light from good to poor, blurred or sharp, among tubes, lamps, glints
  /// and patches of sun, from 1.5 to 4 m, tilted by up to 10 degrees; half of them with a sheet that may
  /// occlude a marker.
  adverse,
  /// The same without any marker.
  empty,
  /// One marker whose O, X or Y is occluded wholly or in part, or cut by the image border.
  direction_dot_lost,
};

/// Runs on all cores; the counts depend on the seed only. `done` is called with the number of frames done,
/// from any thread.
FrameCounts count_frames(HardFrames kind, const MethodChoice& choice, int frames, std::uint64_t seed,
                         const std::function<void(int frames)>& done);

}  // namespace lodestar
