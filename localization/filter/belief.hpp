#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/ceiling/visual_odometry_increment.hpp"
#include "localization/detection/inline_vector.hpp"
#include "localization/filter/pose_filter_options.hpp"
#include "localization/pose/mount.hpp"
#include "maps/motion.hpp"

// The pose filter's belief at one time, with the prediction by wheel travel and the correction by camera
// fixes of an extended Kalman filter (Thrun, Burgard and Fox 2005, chapter 3.3).
namespace lodestar {

/// Before anything is learned in this drive: those of an earlier one, or the prior.
WheelScales initial_scales(const PoseFilterOptions& options);

/// A marker, and the odometer distance at which a fix last used it.
struct RecentMarker {
  int id = 0;
  double rolled_m = 0.0;
};

/// A marker whose offset from its registered place the belief has as a state.
struct RecentOffset {
  int id = 0;
  Stamp used;  ///< by the newest fix that did
};

struct Lag {
  double mean_s = 0.0;
  double sigma_s = 0.0;
};

/// Before any fix: readings of a good bus are 0 to 20 ms old, those of a slow one 50.
inline constexpr Lag initial_lag{.mean_s = 0.0, .sigma_s = 0.02};

struct Belief {
  /// Four parts of three: the pose (x_m, y_m, yaw_rad) that the wheels' readings describe, the scales, the
  /// error (x_m, y_m, yaw_rad) that nearby fixes share, and the keyframe's pose (x_m, y_m, yaw_rad). The
  /// readings' lag (s): the robot has left that pose at its velocity for so long. And of each marker in
  /// `offsets` its offset as in PoseByOffset, in its sigmas.
  static constexpr int own_states = 13;
  static constexpr int states_of_offset = 5;
  static constexpr int most_offsets = 8;  ///< a view has one to four, and a robot turns back to some
  static_assert(most_offsets >= most_offsets_of_fix, "a fix needs all of its own");
  static constexpr int most_states = own_states + most_offsets * states_of_offset;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_states, most_states>;
  /// Derivative of what has three degrees of freedom.
  using ByState = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, most_states>;
  using Gain = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most_states, 3>;

  WheelTravel travel;
  std::optional<Stamp> keyframe_stamp;  ///< capture time of the keyframe; nothing when there is none
  std::vector<RecentMarker> markers;    ///< used by fixes nearby
  InlineVector<RecentOffset, most_offsets> offsets;
  double registry_variance = 1.0;  ///< of the offsets before any fix; as PoseFilterOptions::registry_variance
  /// Prior covariance of the error that nearby fixes share.
  Eigen::Matrix3d shared = Eigen::Matrix3d::Zero();
  BodyVelocity velocity;  ///< by the readings, smoothed
  State mean = State::Zero(own_states);
  Covariance covariance = Covariance::Zero(own_states, own_states);

  /// Where the robot is: the readings' pose, and the motion of their lag.
  [[nodiscard]] Pose2 map_from_base() const;
  [[nodiscard]] WheelScales scales() const { return {mean.segment<3>(3), covariance.block<3, 3>(3, 3)}; }
  [[nodiscard]] Pose2 map_from_keyframe() const { return {mean.segment<2>(9), mean[11]}; }
};

/// The belief from one fix alone.
Belief belief_from(const PlanarFix& fix, const WheelTravel& travel, const WheelScales& scales,
                   const PoseFilterOptions& options, const Lag& lag = initial_lag);

/// Prediction: the belief after the wheels have rolled on an arc of constant curvature.
Belief moved(const Belief& from, const WheelTravel& travel, const PoseFilterOptions& options);

/// The gate: a fix or a visual-odometry increment with a larger squared Mahalanobis distance (3 degrees of
/// freedom) is rejected as an outlier. It rejects one true one in a thousand.
double gate_squared_distance();

/// Squared Mahalanobis distance, with 3 degrees of freedom, of a fix of the same time.
double squared_distance(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options);

/// Logarithm of the density (1/(m^2 rad)) that the belief expects there, of a fix of the same time.
double log_density(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options);

/// The belief corrected by a fix of the same time.
Belief corrected(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options);

/// The belief with a new keyframe, taken at the same time, in place of the old one.
Belief with_keyframe(const Belief& belief, double sway_m, const PoseFilterOptions& options);

/// Squared Mahalanobis distance, with 3 degrees of freedom, of a visual-odometry increment from the keyframe
/// to the belief's time.
double squared_distance(const Belief& belief, const VisualOdometryIncrement& motion,
                        const PoseFilterOptions& options);

/// The belief corrected by a visual-odometry increment; `becomes_keyframe`: the later frame becomes the
/// keyframe. Its pose is better known from the old keyframe than from the base's pose, as the body sways.
/// Cloned camera states: Roumeliotis and Burdick 2002.
Belief corrected(const Belief& belief, const VisualOdometryIncrement& motion, bool becomes_keyframe,
                 const PoseFilterOptions& options);

/// Covariance of the pose (x_m, y_m, yaw_rad).
Eigen::Matrix3d pose_covariance(const Belief& belief, const PoseFilterOptions& options);

/// Pose of the base after its wheels have rolled these distances.
Pose2 rolled(const Pose2& from, double left_m, double right_m, double track_width_m);

}  // namespace lodestar
