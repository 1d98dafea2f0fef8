#pragma once

#include <span>
#include <vector>

// Calibration of stated probabilities (reliability diagram; Murphy and Winkler 1977).
namespace lodestar {

/// The stated probability of one reading, and its outcome.
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

/// Readings binned by stated probability. The bins become narrower towards 1, where nearly all readings are:
/// 0.5, 0.9, 0.99, 0.999. Empty bins are omitted.
std::vector<ReliabilityBin> reliability(std::span<const StatedOutcome> outcomes);

/// Mean squared difference between stated probability and outcome (Brier 1950); 0 without outcomes.
double brier_score(std::span<const StatedOutcome> outcomes);

}  // namespace lodestar
