#include "app/bench/reliability.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lodestar {

std::vector<ReliabilityBin> reliability(std::span<const StatedOutcome> outcomes) {
  constexpr std::array edges{0.0, 0.5, 0.9, 0.99, 0.999, 1.0};
  std::vector<ReliabilityBin> bins;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) bins.push_back({edges[i], edges[i + 1]});
  for (const StatedOutcome& outcome : outcomes) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, outcome.probability);
    ReliabilityBin& bin = bins[static_cast<std::size_t>(above - edges.begin() - 1)];
    ++bin.count;
    bin.mean_stated += outcome.probability;
    bin.share_right += outcome.right ? 1.0 : 0.0;
  }
  std::erase_if(bins, [](const ReliabilityBin& bin) { return bin.count == 0; });
  for (ReliabilityBin& bin : bins) {
    bin.mean_stated /= bin.count;
    bin.share_right /= bin.count;
  }
  return bins;
}

double brier_score(std::span<const StatedOutcome> outcomes) {
  double sum = 0.0;
  for (const StatedOutcome& outcome : outcomes) {
    const double off = outcome.probability - (outcome.right ? 1.0 : 0.0);
    sum += off * off;
  }
  return outcomes.empty() ? 0.0 : sum / static_cast<double>(outcomes.size());
}

}  // namespace lodestar
