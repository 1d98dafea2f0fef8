#pragma once

#include <string>
#include <vector>

#include "app/bench/counts.hpp"

// Recall on ceilings with structure, kind by kind.
namespace lodestar {

struct CeilingCounts {
  std::string name;
  bool dots_touch = false;  ///< are the dots blurred into each other?
  FrameCounts counts;
};

/// Where the frames of one row of the table come from.
struct CeilingScenes {
  std::string name;
  bool dots_touch = false;
  SceneSource source;
};

/// One row for each kind of ceiling: bright (90 to 140 of 255 at the middle), from 1.5 to 3.2 m, tilted by up
/// to 10 degrees, with 25 markers anywhere on its structure. Then two rows with dots that touch: defocused
/// (blur of 1.5 to 2.5 px) and far away (3.5 to 5 m, where a dot is 3 to 4 px wide, blur of 0.8 to 1.4 px).
std::vector<CeilingScenes> ceiling_scenes();

/// Number of rows.
std::size_t ceiling_rows();

/// `frames` of each row. Runs on all cores; the counts depend on the seed only.
std::vector<CeilingCounts> count_ceilings(const MethodChoice& choice, int frames, std::uint64_t seed,
                                          const std::function<void(int frames)>& done);

}  // namespace lodestar
