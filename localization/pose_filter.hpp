#pragma once

#include <deque>
#include <optional>

#include "localization/belief_history.hpp"
#include "localization/mount.hpp"
#include "localization/pose_filter_options.hpp"
#include "maps/motion.hpp"

namespace lodestar {

enum class FixOutcome {
  accepted,
  started,       ///< enough fixes agree: the estimate begins
  collecting,    ///< before the start: waiting for more fixes that agree
  refused_gate,  ///< contradicts the estimate
  refused_late,  ///< older than the history or the estimate, or too far ahead of the wheels' last word
  relocated,     ///< enough refused fixes agree among themselves: the estimate has moved to them
};

/// Fuses wheel travel and camera fixes by covariance: an extended Kalman filter over the pose, what the
/// wheels' readings must be scaled by, and the error that neighbouring fixes share. A fix is applied at its
/// capture time and the travel since then is replayed over it. A value type: copying it copies the belief.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options = {}) : options_(options) {}

  /// Moves the belief by the wheels' travel since the last call. Stamps ascend; a reading that is not newer
  /// than the last one is ignored.
  void add_travel(const WheelTravel& travel);

  /// Corrects the belief at the fix's capture time.
  FixOutcome add_fix(const PlanarFix& fix);

  /// The belief at the newest wheel travel; nothing before the filter has started.
  [[nodiscard]] std::optional<PoseEstimate> estimate() const;

  /// Learned scales (true travel over reported travel), left and right.
  [[nodiscard]] Vec2 wheel_scales() const { return scales().mean.head<2>(); }

  /// Learned scale of turns: the track width as built over the one that the floor feels.
  [[nodiscard]] double turn_scale() const { return scales().mean.z(); }

 private:
  /// A fix together with the wheels' reading at its time.
  struct PlacedFix {
    PlanarFix fix;
    WheelTravel travel;
  };

  /// A belief that rests only on fixes which the estimate (if there is one) contradicts.
  struct Rival {
    BeliefHistory history;
    int fixes = 1;
  };

  [[nodiscard]] std::optional<PlacedFix> placed(const PlanarFix& fix) const;
  [[nodiscard]] PlacedFix brought_back(const PlanarFix& fix) const;
  [[nodiscard]] Rival rival_from(const PlacedFix& placed) const;
  [[nodiscard]] WheelScales scales() const;

  PoseFilterOptions options_;
  std::deque<WheelTravel> readings_;  ///< by ascending stamp, over the history
  std::optional<BeliefHistory> believed_;
  std::optional<Rival> rival_;
  Stamp last_fix_;
};

}  // namespace lodestar
