#pragma once

#include <deque>
#include <optional>

#include "localization/filter/belief.hpp"

namespace lodestar {

/// A belief from its beginning, or over the last `history`, to the newest wheel reading, so that a fix can be
/// applied at its capture time and the travel since then replayed over it.
class BeliefHistory {
 public:
  explicit BeliefHistory(const Belief& beginning)
      : beliefs_{beginning}, last_fix_(beginning.travel.stamp), last_motion_(beginning.travel.stamp) {}

  /// Moves on to a newer reading, and forgets what is older than the history.
  void add_travel(const WheelTravel& travel, const PoseFilterOptions& options);

  /// Corrects the belief at the time of `travel` and all that follow. False, and nothing changed, for a fix
  /// that the belief of that time contradicts or that is older than all beliefs.
  bool add_fix(const PlanarFix& fix, const WheelTravel& travel, const PoseFilterOptions& options);

  /// A picture of the ceiling, taken at the time of `travel`, is the one that later ones will be laid over.
  /// False for one that is older than all beliefs.
  bool keep_picture(const WheelTravel& travel, double sway_m, const PoseFilterOptions& options);

  /// Corrects as add_fix() does, by what the kept picture and one of the time of `travel` show; `keeps`: that
  /// one is kept instead. False also when another picture is the kept one.
  bool add_motion(const VisualOdometryIncrement& motion, const WheelTravel& travel, bool keeps,
                  const PoseFilterOptions& options);

  /// The belief at the time of `travel`; nothing when that is before all beliefs.
  [[nodiscard]] std::optional<Belief> at(const WheelTravel& travel, const PoseFilterOptions& options) const;

  [[nodiscard]] Stamp oldest() const { return beliefs_.front().travel.stamp; }
  [[nodiscard]] const Belief& newest() const { return beliefs_.back(); }

 private:
  void put(const Belief& belief, const PoseFilterOptions& options);

  std::deque<Belief> beliefs_;  ///< by ascending stamp, never empty
  Stamp last_fix_;              ///< the newest applied
  Stamp last_motion_;           ///< the same
};

}  // namespace lodestar
