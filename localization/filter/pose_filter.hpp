#pragma once

#include <deque>
#include <optional>
#include <set>

#include "localization/filter/belief_history.hpp"
#include "localization/filter/pose_filter_options.hpp"
#include "localization/filter/zero_velocity_detector.hpp"
#include "localization/pose/mount.hpp"
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

/// A fix beside the pose that the estimate had at its time.
struct FixExpectation {
  Pose2 map_from_base;
  double squared_distance = 0.0;  ///< of the fix, Mahalanobis with 3 degrees of freedom
  bool agrees = false;            ///< near enough for the filter to accept it
};

/// What the estimate expects two pictures of the ceiling to show.
struct PictureExpectation {
  Stamp from;  ///< when the kept one was taken
  Pose2 then_from_now;
};

/// Fuses wheel travel and camera fixes by covariance: an extended Kalman filter over the pose, what the
/// wheels' readings must be scaled by, and the error that neighbouring fixes share. A fix is applied at its
/// capture time and the travel since then is replayed over it. Where fixes are missing, pictures of the plain
/// ceiling may tell how the robot moves. A value type: copying it copies the belief.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options = {})
      : options_(options), zero_velocity_(options.wheel_step_m) {}

  /// Moves the belief by the wheels' travel since the last call. Stamps ascend; a reading that is not newer
  /// than the last one is ignored.
  void add_travel(const WheelTravel& reading);

  /// Corrects the belief at the fix's capture time. Where one marker alone contradicts the estimate by little
  /// it may itself have moved, and the estimate stays until a second marker says the same.
  FixOutcome add_fix(const PlanarFix& fix);

  /// Where the picture of the ceiling that is kept was taken, and how the robot has moved since, at another
  /// time. Nothing while none is kept, and beyond the wheels' readings.
  [[nodiscard]] std::optional<PictureExpectation> expected_motion(Stamp stamp) const;

  /// From now on later pictures of the ceiling are laid over one of that time. False, and nothing changes,
  /// before the start and beyond the wheels' readings.
  bool keep_picture(Stamp stamp, double sway_m);

  /// Corrects the belief by what the kept picture and a later one show; `keeps`: the later one is kept
  /// instead. False, and nothing changes, where that contradicts the wheels or another picture is kept.
  bool add_motion(const VisualOdometryIncrement& motion, bool keeps);

  /// Begins anew at a pose that somebody vouches for, whatever was believed. False, and nothing changes, when
  /// the fix is out of the readings' reach.
  bool start_at(const PlanarFix& fix);

  /// What the estimate expected of a fix. Nothing before the start, and for a fix that would be late.
  [[nodiscard]] std::optional<FixExpectation> expectation(const PlanarFix& fix) const;

  /// Neither wheel has turned for a while: nothing drifts, and what an encoder on the edge of a step says is
  /// no travel.
  [[nodiscard]] bool standing() const { return zero_velocity_.standing(); }

  /// The belief at the newest wheel travel; nothing before the filter has started.
  [[nodiscard]] std::optional<PoseEstimate> estimate() const;

  /// The belief at another time within the history, or a little ahead of it: what to expect of a frame taken
  /// then. Nothing before the start and beyond that reach.
  [[nodiscard]] std::optional<PoseEstimate> estimate_at(Stamp stamp) const;

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
    std::set<int> ids;  ///< of the markers that the fixes rest on
  };

  [[nodiscard]] std::optional<WheelTravel> travel_at(Stamp stamp) const;
  [[nodiscard]] std::optional<PlacedFix> placed(const PlanarFix& fix) const;
  [[nodiscard]] PlacedFix brought_back(const PlanarFix& fix) const;
  void add_to_rival(const PlacedFix& placed);
  [[nodiscard]] bool rival_prevails() const;
  void begin_with(Rival rival, Stamp last_fix);
  [[nodiscard]] Rival rival_from(const PlacedFix& placed) const;
  [[nodiscard]] WheelScales scales() const;

  PoseFilterOptions options_;
  ZeroVelocityDetector zero_velocity_;
  std::deque<WheelTravel> readings_;  ///< by ascending stamp, over the history
  std::optional<BeliefHistory> believed_;
  std::optional<Rival> rival_;
  Stamp last_fix_;
  Stamp last_agreed_;
  int motions_refused_ = 0;  ///< in a row since a fix agreed; enough of them, and the ceiling is not heard
};

}  // namespace lodestar
