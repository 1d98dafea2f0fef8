#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/ceiling/visual_odometry_increment.hpp"
#include "localization/filter/pose_filter_options.hpp"
#include "localization/pose/mount.hpp"
#include "maps/motion.hpp"

// What the pose filter believes at one time, and how wheel travel and camera fixes change it: the prediction
// and the correction of an extended Kalman filter (Thrun, Burgard and Fox 2005, chapter 3.3).
namespace lodestar {

/// True over reported: the travel of the left and of the right wheel, and the turn that follows from them.
/// The third is the track width as built over the one that the floor feels.
struct WheelScales {
  Vec3 mean = Vec3::Ones();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

WheelScales scales_as_built(const PoseFilterOptions& options);

/// A marker, and what the wheels had rolled when a fix last rested on it.
struct MarkerOnTheWay {
  int id = 0;
  double rolled_m = 0.0;
};

struct Belief {
  /// Four parts of three: the pose (x_m, y_m, yaw_rad), the scales, the error (x_m, y_m, yaw_rad) that all
  /// fixes about here have in common, and the place (x_m, y_m, yaw_rad) that a picture of the ceiling shows.
  using State = Eigen::Matrix<double, 12, 1>;
  using Covariance = Eigen::Matrix<double, 12, 12>;

  WheelTravel travel;
  std::optional<Stamp> pictured;        ///< when that picture was taken; nothing when there is none
  std::vector<MarkerOnTheWay> markers;  ///< that fixes about here rested on
  Eigen::Matrix3d shared = Eigen::Matrix3d::Zero();  ///< covariance of such fixes' common error, before any
  State mean = State::Zero();
  Covariance covariance = Covariance::Zero();

  [[nodiscard]] Pose2 map_from_base() const { return {mean.head<2>(), mean[2]}; }
  [[nodiscard]] WheelScales scales() const { return {mean.segment<3>(3), covariance.block<3, 3>(3, 3)}; }
  [[nodiscard]] Pose2 map_from_pictured() const { return {mean.segment<2>(9), mean[11]}; }
};

/// The pose by one fix alone.
Belief belief_from(const PlanarFix& fix, const WheelTravel& travel, const WheelScales& scales,
                   const PoseFilterOptions& options);

/// The belief after the wheels have rolled on: an arc of constant curvature.
Belief moved(const Belief& from, const WheelTravel& travel, const PoseFilterOptions& options);

/// The gate: a fix or a motion that lies farther off (squared Mahalanobis distance, 3 degrees of freedom) is
/// taken for false. Of a thousand true ones it refuses one.
double gate_squared_distance();

/// How far a fix of the same time lies off, squared Mahalanobis distance with 3 degrees of freedom.
double squared_distance(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options);

/// The belief corrected by a fix of the same time.
Belief corrected(const Belief& belief, const PlanarFix& fix, const PoseFilterOptions& options);

/// The belief with a picture of the ceiling, taken at the same time, in place of the one before.
Belief pictured(const Belief& belief, double sway_m, const PoseFilterOptions& options);

/// How far what two pictures of the ceiling show lies off, squared Mahalanobis distance with 3 degrees of
/// freedom: the last one pictured and another of the belief's time.
double squared_distance(const Belief& belief, const VisualOdometryIncrement& motion,
                        const PoseFilterOptions& options);

/// The belief corrected by what two pictures of the ceiling show; `keeps`: the later one takes the place of
/// the earlier, which it knows better than the base's pose does, for that sways. Cloned states of one camera:
/// Roumeliotis and Burdick 2002.
Belief corrected(const Belief& belief, const VisualOdometryIncrement& motion, bool keeps,
                 const PoseFilterOptions& options);

/// How sure the pose (x_m, y_m, yaw_rad) is.
Eigen::Matrix3d pose_covariance(const Belief& belief, const PoseFilterOptions& options);

/// Where the base is after its wheels have rolled so far.
Pose2 rolled(const Pose2& from, double left_m, double right_m, double track_width_m);

}  // namespace lodestar
