#include "app/report/nees.hpp"

#include <algorithm>
#include <map>

#include "app/report/run_statistics.hpp"
#include "maps/chi_square.hpp"

namespace lodestar {
namespace {

constexpr int first_seconds = 5;
constexpr double gap_s = 0.3;

struct Sum {
  int count = 0;
  double nees = 0.0;
};

constexpr double below = 0.025;  // 95 % lie between
constexpr double above = 0.975;

/// Quantile of the mean over so many independent runs, each with 3 degrees of freedom.
double bound_of_mean(int runs, double probability) {
  return chi_square_quantile(probability, 3.0 * runs) / runs;
}

}  // namespace

std::string_view to_string(NeesPhase phase) {
  switch (phase) {
    case NeesPhase::start_up:
      return "start-up";
    case NeesPhase::steady:
      return "steady";
    case NeesPhase::gap:
      return "marker gaps";
  }
  return "";
}

std::vector<NeesSample> nees_samples(const RunRecord& record) {
  std::vector<NeesSample> samples;
  const std::vector<EstimateError> errors = estimate_errors(record);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const int second = static_cast<int>(errors[i].time_s - errors.front().time_s);
    if (!samples.empty() && second <= samples.back().second) continue;
    const PoseEstimate& estimate = record.steps[i].estimate;
    NeesPhase phase = NeesPhase::steady;
    if (second < first_seconds)
      phase = NeesPhase::start_up;
    else if (seconds(estimate.stamp - estimate.last_fix) > gap_s)
      phase = NeesPhase::gap;
    samples.push_back({phase, second, errors[i].nees});
  }
  return samples;
}

std::optional<NeesVerdict> nees_verdict(const std::vector<std::vector<NeesSample>>& runs,
                                        std::optional<NeesPhase> phase) {
  std::map<int, Sum> by_second;
  Sum all;
  for (const std::vector<NeesSample>& run : runs) {
    for (const NeesSample& sample : run) {
      if (phase && sample.phase != *phase) continue;
      for (Sum* sum : {&all, &by_second[sample.second]}) {
        ++sum->count;
        sum->nees += sample.nees;
      }
    }
  }
  if (all.count == 0) return std::nullopt;
  const auto inside = std::ranges::count_if(by_second, [](const auto& entry) {
    const Sum& sum = entry.second;
    const double mean = sum.nees / sum.count;
    return mean >= bound_of_mean(sum.count, below) && mean <= bound_of_mean(sum.count, above);
  });
  const int count = static_cast<int>(runs.size());
  return NeesVerdict{.mean = all.nees / all.count,
                     .low = bound_of_mean(count, below),
                     .high = bound_of_mean(count, above),
                     .share_inside = static_cast<double>(inside) / static_cast<double>(by_second.size()),
                     .seconds = static_cast<int>(by_second.size())};
}

}  // namespace lodestar
