#pragma once

#include <deque>
#include <optional>
#include <set>

#include "localization/filter/arrival_jitter.hpp"
#include "localization/filter/belief_history.hpp"
#include "localization/filter/pose_filter_options.hpp"
#include "localization/filter/registry_variance.hpp"
#include "localization/filter/zero_velocity_detector.hpp"
#include "localization/pose/mount.hpp"
#include "maps/motion.hpp"

namespace lodestar {

enum class FixOutcome {
  accepted,
  started,       ///< enough fixes agree: the estimate begins
  collecting,    ///< before the start: waits for more fixes that agree
  refused_gate,  ///< contradicts the estimate
  refused_late,  ///< older than the history or the estimate, or too far ahead of the newest wheel reading
  relocated,     ///< enough refused fixes agree with each other: the estimate was relocated to them
};

/// A fix's comparison with the estimate at its time.
struct FixExpectation {
  Pose2 map_from_base;
  double squared_distance = 0.0;  ///< of the fix, Mahalanobis with 3 degrees of freedom
  bool agrees = false;            ///< passes the filter's gate
};

/// Predicted visual-odometry increment.
struct MotionExpectation {
  Stamp from;  ///< capture time of the keyframe
  Pose2 then_from_now;
};

/// Fuses wheel travel and camera fixes in an extended Kalman filter over the pose, the wheels' scales, and
/// the error that nearby fixes share. A fix is applied at its capture time, and the travel since then is
/// replayed. Between fixes, visual odometry on the ceiling may observe the motion. A value type: copying it
/// copies the belief.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options = {})
      : options_(options), zero_velocity_(options.wheel_step_m), registry_(options.registry_variance) {}

  /// Predicts the belief by the wheels' travel since the last call. Stamps ascend; a reading that is not
  /// newer than the last one is ignored.
  void add_travel(const WheelTravel& reading);

  /// Corrects the belief at the fix's capture time. Where fixes of one marker alone contradict the estimate
  /// by little, the marker may be displaced, and the estimate stays until fixes of a second marker agree with
  /// them.
  FixOutcome add_fix(const PlanarFix& fix);

  /// The capture time of the keyframe, and the predicted motion from it to the given time. Nothing without a
  /// keyframe, and beyond the wheels' readings.
  [[nodiscard]] std::optional<MotionExpectation> expected_motion(Stamp stamp) const;

  /// Makes the frame of that time the keyframe of visual odometry. False, without any change, before the
  /// start and beyond the wheels' readings.
  bool set_keyframe(Stamp stamp, double sway_m);

  /// Corrects the belief by a visual-odometry increment from the keyframe; `becomes_keyframe`: the later
  /// frame becomes the keyframe. False, without any change of the belief, where it contradicts odometry or
  /// starts from another keyframe. After two contradictions in a row the ceiling confirms nothing until a fix
  /// agrees, and the estimate is as uncertain as to cover both, and where wheels that slip may lead.
  bool add_motion(const VisualOdometryIncrement& motion, bool becomes_keyframe);

  /// Sets the initial pose, whatever was believed. False, without any change, when the fix is beyond the
  /// wheels' readings.
  bool start_at(const PlanarFix& fix);

  /// The estimate's pose at a fix's time and the fix's distance to it. Nothing before the start, and for a
  /// fix that would be late.
  [[nodiscard]] std::optional<FixExpectation> expectation(const PlanarFix& fix) const;

  /// Zero-velocity update: neither wheel has turned for 0.3 s, so the pose does not drift, and the jitter of
  /// an encoder at the edge of a step is not taken for travel.
  [[nodiscard]] bool standing() const { return zero_velocity_.standing(); }

  /// The belief at the newest wheel travel; nothing before the filter has started.
  [[nodiscard]] std::optional<PoseEstimate> estimate() const;

  /// The belief at another time within the history, or up to 0.1 s after it: the prediction for a frame taken
  /// then. Nothing before the start and beyond that range.
  [[nodiscard]] std::optional<PoseEstimate> estimate_at(Stamp stamp) const;

  /// The learned scales of wheels and turns, with their covariance.
  [[nodiscard]] WheelScales scales() const;

  /// Learned scales (true travel over reported travel), left and right.
  [[nodiscard]] Vec2 wheel_scales() const { return scales().mean.head<2>(); }

  /// Learned scale of turns: the track width as built over the effective one on this floor.
  [[nodiscard]] double turn_scale() const { return scales().mean.z(); }

  /// Learned variance of the markers' offsets, in squared sigmas of the registry.
  [[nodiscard]] double registry_variance() const { return options_.registry_variance; }

 private:
  /// A fix with the wheels' reading at its time.
  struct PlacedFix {
    PlanarFix fix;
    WheelTravel travel;
  };

  /// A belief that rests only on fixes which the estimate (if there is one) contradicts.
  struct Rival {
    BeliefHistory history;
    int fixes = 1;
    std::set<int> ids;  ///< of the markers used by its fixes
  };

  /// Either the wheels or the ceiling tell a wrong motion: until a fix agrees.
  struct OdometryDoubt {
    Stamp keyframe;
    Vec3 apart = Vec3::Zero();  ///< x_m, y_m, yaw_rad in the map: how far the ceiling tells another pose
    WheelTravel since;
  };

  [[nodiscard]] std::optional<WheelTravel> travel_at(Stamp stamp) const;
  [[nodiscard]] std::optional<PlacedFix> placed(const PlanarFix& fix) const;
  [[nodiscard]] PlacedFix at_newest_reading(const PlanarFix& fix) const;
  void learn_registry(const PlacedFix& placed);
  void add_to_rival(const PlacedFix& placed);
  [[nodiscard]] bool rival_prevails() const;
  void doubt_odometry(const VisualOdometryIncrement& motion, const WheelTravel& travel);
  [[nodiscard]] Eigen::Matrix3d covariance_of_doubt() const;
  void end_doubt();
  void begin_with(Rival rival, Stamp last_fix);
  [[nodiscard]] Rival rival_from(const PlacedFix& placed) const;

  PoseFilterOptions options_;
  ZeroVelocityDetector zero_velocity_;
  ArrivalJitter jitter_;
  std::deque<WheelTravel> readings_;  ///< by ascending stamp, over the history
  RegistryVariance registry_;
  std::set<int> markers_met_;  ///< each says once how good the registry is
  std::optional<BeliefHistory> believed_;
  std::optional<Rival> rival_;
  Stamp last_fix_;
  Stamp last_agreed_;
  int motions_refused_ = 0;  ///< consecutive, since a fix agreed
  std::optional<OdometryDoubt> doubt_;
};

}  // namespace lodestar
