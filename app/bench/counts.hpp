#pragma once

#include <cstdint>

#include "app/bench/hard_scene.hpp"
#include "app/bench/method.hpp"
#include "app/bench/reliability.hpp"

// Correct and wrong readings of markers, counted over many hard frames.
namespace lodestar {

struct FrameCounts {
  int frames = 0;
  int markers = 0;  ///< fully in view and not occluded, over all frames
  int read = 0;     ///< of these
  int right = 0;    ///< readings, also of markers partly in view
  int wrong = 0;    ///< readings without a true marker
  int frames_with_wrong = 0;
  std::vector<StatedOutcome> stated;  ///< of all readings with a stated probability
};

/// Where frames come from: scenes of some frames each, and views of a scene.
struct SceneSource {
  std::function<HardScene(Random& random)> scene;
  std::function<BenchView(const HardScene& scene, Random& random)> view;
};

/// Frames of any source, `random` decides which.
FrameCounts count_frames(const SceneSource& source, const MethodChoice& choice, int frames,
                         const Random& random, const std::function<void(int frames)>& done);

/// Runs on all cores; the counts depend on the seed only. `done` is called with the number of frames done,
/// from any thread.
FrameCounts count_frames(HardFrames kind, const MethodChoice& choice, int frames, std::uint64_t seed,
                         const std::function<void(int frames)>& done);

}  // namespace lodestar
