#pragma once

#include <optional>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// True over reported: the travel of the left and of the right wheel, and the resulting turn. The third is
/// the track width as built over the effective one on this floor.
struct WheelScales {
  Vec3 mean = Vec3::Ones();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Options that differ between robots and sites; most are set in robot.yaml.
struct PoseFilterOptions {
  double track_width_m = 0.4;  ///< between the wheels' contact points, as built
  /// Random error of one wheel's travel, per square root of metre rolled.
  double wheel_noise_m_per_sqrt_m = 0.002;
  double wheel_step_m = 0.001;  ///< resolution of the wheels' travel readings
  /// Standard deviation of the readings' delay from one to the next. PoseFilter measures it.
  double reading_jitter_s = 0.0;
  /// Of the markers' offsets from their registered places, in squared sigmas of the registry; one of
  /// RegistryVariance::candidates. PoseFilter begins with it and learns.
  double registry_variance = 1.0;
  double initial_wheel_scale_sigma = 0.02;    ///< prior of the wheels' scales
  double initial_turn_scale_sigma = 0.02;     ///< prior of the track width's scale
  std::optional<WheelScales> learned_scales;  ///< in place of that prior, from an earlier drive
  /// Drift of these scales: 0.3 % in 100 m. Assumed.
  double wheel_scale_drift_per_sqrt_m = 0.0003;
  /// Share of each fix's correction of these scales that is applied: a rare slip of a wheel between two fixes
  /// looks like wheels of unequal size, and would turn a robot that then drives without markers. Chosen by
  /// hand.
  double scales_learned_by_one_fix = 0.8;
  /// Error of survey, mount and floor that fixes share, in addition to that of their markers, while the robot
  /// stays about where it is and sees the same markers.
  double fix_sigma_floor_m = 0.002;
  double fix_sigma_floor_rad = radians(0.1);
  /// A body sways slowly on its floor, and the camera's tilt with it: fixes much nearer to each other in time
  /// than this have the same error, not two. How long was chosen: see
  /// variance_growth in belief_history.cpp.
  Duration fix_correlation = std::chrono::milliseconds(60);
};

/// Beliefs are kept for this long, and older fixes are refused: four times the age at which CameraWatch calls
/// a frame late.
inline constexpr Duration belief_history = std::chrono::seconds(1);

}  // namespace lodestar
