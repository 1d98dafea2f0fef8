#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "app/report/run_record.hpp"

// Filter consistency: the normalized estimation error squared (NEES) of a pose, averaged over many runs,
// against the bounds of chi-squared (Bar-Shalom, Li and Kirubarajan 2001, chapter 5.4).
namespace lodestar {

/// What the estimate was based on at the time.
enum class NeesPhase {
  start_up,  ///< the first five seconds
  steady,    ///< a fix within the last 0.3 s
  gap        ///< no marker seen for longer than that
};
std::string_view to_string(NeesPhase phase);

struct NeesSample {
  NeesPhase phase = NeesPhase::start_up;
  int second = 0;  ///< since the first estimate
  double nees = 0.0;
};

/// One for each second of a run: errors closer in time are strongly correlated.
std::vector<NeesSample> nees_samples(const RunRecord& record);

struct NeesVerdict {
  double mean = 0.0;  ///< over all samples; 3 for a consistent filter
  /// Interval in which the mean of all runs at one second lies in 95 % of all seconds, for a consistent
  /// filter.
  double low = 0.0;
  double high = 0.0;
  double share_inside = 0.0;  ///< share of the seconds inside, each with the bounds for its number of runs
  int seconds = 0;
};

/// Over the runs' samples, or those of one phase; nothing without samples.
std::optional<NeesVerdict> nees_verdict(const std::vector<std::vector<NeesSample>>& runs,
                                        std::optional<NeesPhase> phase = std::nullopt);

}  // namespace lodestar
