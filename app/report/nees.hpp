#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "app/report/run_record.hpp"

// Is the filter as sure of itself as it should be? The normalized estimation error squared of a pose,
// averaged over many runs, against the bounds of chi-squared (Bar-Shalom, Li and Kirubarajan 2001,
// chapter 5.4).
namespace lodestar {

/// What the estimate rested on at the time.
enum class NeesPhase {
  start_up,  ///< the first five seconds
  steady,    ///< a fix within the last 0.3 s
  gap        ///< no marker seen for longer than that
};
std::string_view to_string(NeesPhase phase);

struct NeesSample {
  NeesPhase phase = NeesPhase::start_up;
  int second = 0;  ///< since the estimate began
  double nees = 0.0;
};

/// One for each second of a run: closer together, errors are nearly the same ones.
std::vector<NeesSample> nees_samples(const RunRecord& record);

struct NeesVerdict {
  double mean = 0.0;  ///< over all samples; 3 for an honest filter
  /// Within which the mean of all runs at one second lies in 95 % of all seconds.
  double low = 0.0;
  double high = 0.0;
  double share_inside = 0.0;  ///< of the seconds, each with the bounds of the runs that count there
  int seconds = 0;
};

/// Over the runs' samples, or those of one phase. Nothing where there are none.
std::optional<NeesVerdict> nees_verdict(const std::vector<std::vector<NeesSample>>& runs,
                                        std::optional<NeesPhase> phase = std::nullopt);

}  // namespace lodestar
