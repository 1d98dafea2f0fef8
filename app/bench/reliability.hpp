#pragma once

#include <span>
#include <vector>

// Is a stated probability to be believed? (Reliability diagram; Murphy and Winkler 1977.)
namespace lodestar {

/// What was stated about one reading, and what came of it.
struct StatedOutcome {
  double probability = 0.0;  ///< stated: that the reading is right
  bool right = false;
};

struct ReliabilityBin {
  double low = 0.0;  ///< stated probabilities in [low, high); the last bin holds 1 too
  double high = 1.0;
  int count = 0;
  double mean_stated = 0.0;
  double share_right = 0.0;
};

/// Readings by what was stated. The bins become narrower towards 1, where nearly all readings are and where
/// it matters: 0.5, 0.9, 0.99, 0.999. Bins without readings are left out.
std::vector<ReliabilityBin> reliability(std::span<const StatedOutcome> outcomes);

/// Mean squared difference between what was stated and what came (Brier 1950); 0 for no outcomes.
double brier_score(std::span<const StatedOutcome> outcomes);

}  // namespace lodestar
