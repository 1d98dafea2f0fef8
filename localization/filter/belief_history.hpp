#pragma once

#include <deque>
#include <optional>
#include <variant>

#include "localization/filter/belief.hpp"

namespace lodestar {

/// The beliefs over the last `history`, up to the newest wheel reading, so that a fix is applied at its
/// capture time, and the travel and the other corrections since then are replayed.
class BeliefHistory {
 public:
  explicit BeliefHistory(const Belief& beginning)
      : moments_{{beginning, {}}}, last_fix_(beginning.travel.stamp), last_motion_(beginning.travel.stamp) {}

  /// Predicts up to a newer reading, and drops what is older than the history.
  void add_travel(const WheelTravel& travel, const PoseFilterOptions& options);

  /// Corrects the belief at the time of `travel` and all later ones. False, without any change, for a fix
  /// that the belief of that time contradicts or that is older than all beliefs.
  bool add_fix(const PlanarFix& fix, const WheelTravel& travel, const PoseFilterOptions& options);

  /// Makes a frame taken at the time of `travel` the keyframe. False when it is older than all beliefs.
  bool set_keyframe(const WheelTravel& travel, double sway_m, const PoseFilterOptions& options);

  /// Corrects as add_fix() does, by a visual-odometry increment from the keyframe to the time of `travel`;
  /// `becomes_keyframe`: that frame becomes the keyframe. False also when the increment starts from another
  /// keyframe.
  bool add_motion(const VisualOdometryIncrement& motion, const WheelTravel& travel, bool becomes_keyframe,
                  const PoseFilterOptions& options);

  /// The belief at the time of `travel`; nothing when that is before all beliefs.
  [[nodiscard]] std::optional<Belief> at(const WheelTravel& travel, const PoseFilterOptions& options) const;

  [[nodiscard]] Stamp oldest() const { return moments_.front().belief.travel.stamp; }
  [[nodiscard]] const Belief& newest() const { return moments_.back().belief; }

 private:
  struct Motion {
    VisualOdometryIncrement increment;
    bool becomes_keyframe = false;
  };
  struct Keyframe {
    double sway_m = 0.0;
  };
  using Correction = std::variant<std::monostate, PlanarFix, Motion, Keyframe>;

  /// The belief at one time, after what corrected it.
  struct Moment {
    Belief belief;
    Correction correction;
  };

  static Belief after(const Belief& expected, const Correction& correction, const PoseFilterOptions& options);
  void put(const Belief& expected, Correction correction, const PoseFilterOptions& options);

  std::deque<Moment> moments_;  ///< by ascending stamp, never empty
  Stamp last_fix_;              ///< stamp of the newest fix applied
  Stamp last_motion_;           ///< likewise of visual-odometry increments
};

}  // namespace lodestar
