#pragma once

#include <deque>
#include <optional>

#include "maps/geometry.hpp"
#include "maps/motion.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// True travel over reported travel of the wheels, and true turn over that of the wheels so corrected.
struct TravelScales {
  double left = 1.0;
  double right = 1.0;
  double turn = 1.0;
};

struct WheelTrackOptions {
  double track_width_m = 0.4;
  /// Learned scales farther from 1 are cut: neither tyres nor load change a wheel by more.
  double most_scale_change = 0.1;
  /// How long poses are kept: a scan is used within 0.3 s of its newest beam and took at most 0.2 s.
  Duration kept = std::chrono::seconds(2);
  /// How far beyond the newest reading the last velocity is believed: three periods of a base at 50 Hz. At
  /// 2 rad/s^2 the heading is then 0.2 degrees off.
  Duration ahead = std::chrono::milliseconds(60);
};

/// The robot's way by its wheels alone, in the odometry frame: the base frame at the first reading. It
/// drifts, but never jumps, so that what was seen a second ago is where it was seen.
class WheelTrack {
 public:
  explicit WheelTrack(const WheelTrackOptions& options = {}) : options_(options) {}

  /// Readings that are not newer than the last one are passed over.
  void add(const WheelTravel& travel);

  /// Of all travel from now on, as learned from the fixes: with wheels 3 % unequal, what stands 5 m away
  /// creeps by a decimetre a second while the robot drives.
  void use_scales(const TravelScales& scales);

  /// odom_from_base at a time, on the arc between the readings around it or a little ahead of the newest;
  /// nothing where the readings do not reach.
  [[nodiscard]] std::optional<Pose2> pose_at(Stamp stamp) const;

  /// Between the two newest readings; zero before there are two.
  [[nodiscard]] BodyVelocity velocity() const;

 private:
  struct Mark {
    WheelTravel travel;
    Pose2 odom_from_base;
    double arc_m = 0.0;     ///< of the arc to here from the mark before
    double turn_rad = 0.0;  ///< likewise
  };

  WheelTrackOptions options_;
  TravelScales scales_;
  std::deque<Mark> marks_;  ///< the oldest first
};

}  // namespace lodestar
