#pragma once

#include <optional>
#include <vector>

#include "app/recording/drive_record.hpp"
#include "drivers/simulation/fault.hpp"
#include "drivers/simulation/scoring.hpp"

// What one run leaves behind in memory; run_folder writes it out, figure and report draw it.
namespace lodestar {

/// A drive, and what the judge of the simulated world says of it. Of a real drive there is no truth, no fault
/// and no score.
struct RunRecord : DriveRecord {
  std::vector<std::optional<ArrivalScore>> scores;  ///< of each goal that has ended, when it arrived
  std::vector<TruePose> truth;
  std::vector<double> path_distances_m;  ///< of the true track from the planned curve
  std::vector<FaultEvent> faults;        ///< that were injected
  int contacts = 0;
  ContactScore contact_score;  ///< contacts as events, those with discs among them

  /// The score of a goal of `goals`; nothing where it did not arrive or has no judge.
  [[nodiscard]] std::optional<ArrivalScore> score_of(std::size_t goal) const {
    return goal < scores.size() ? scores[goal] : std::nullopt;
  }
};

}  // namespace lodestar
