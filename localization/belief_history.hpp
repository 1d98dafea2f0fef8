#pragma once

#include <deque>
#include <optional>

#include "localization/belief.hpp"

namespace lodestar {

/// A belief from its beginning, or over the last `history`, to the newest wheel reading, so that a fix can be
/// applied at its capture time and the travel since then replayed over it.
class BeliefHistory {
 public:
  explicit BeliefHistory(const Belief& beginning) : beliefs_{beginning}, last_fix_(beginning.travel.stamp) {}

  /// Moves on to a newer reading, and forgets what is older than the history.
  void add_travel(const WheelTravel& travel, const PoseFilterOptions& options);

  /// Corrects the belief at the time of `travel` and all that follow. False, and nothing changed, for a fix
  /// that the belief of that time contradicts or that is older than all beliefs.
  bool add_fix(const PlanarFix& fix, const WheelTravel& travel, const PoseFilterOptions& options);

  /// The belief at the time of `travel`; nothing when that is before all beliefs.
  [[nodiscard]] std::optional<Belief> at(const WheelTravel& travel, const PoseFilterOptions& options) const;

  [[nodiscard]] Stamp oldest() const { return beliefs_.front().travel.stamp; }
  [[nodiscard]] const Belief& newest() const { return beliefs_.back(); }

 private:
  std::deque<Belief> beliefs_;  ///< by ascending stamp, never empty
  Stamp last_fix_;              ///< the newest applied
};

}  // namespace lodestar
