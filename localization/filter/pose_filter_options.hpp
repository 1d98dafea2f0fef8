#pragma once

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What differs from robot to robot and site to site: robot.yaml says most of it.
struct PoseFilterOptions {
  double track_width_m = 0.4;  ///< between the wheels' contact points, as built
  /// Random error of one wheel's travel, per square root of metre rolled.
  double wheel_noise_m_per_sqrt_m = 0.002;
  double wheel_step_m = 0.001;              ///< readings of a wheel's travel are rounded to it
  double initial_wheel_scale_sigma = 0.02;  ///< how unequal the wheels may be before anything is learned
  double initial_turn_scale_sigma = 0.02;   ///< how wrong the track width may be before anything is learned
  /// How fast these scales may change: by 0.3 % in 100 m. Assumed.
  double wheel_scale_drift_per_sqrt_m = 0.0003;
  /// Of what one fix says about these scales only this share is taken: a rare jerk of a wheel between two
  /// fixes looks like wheels of unequal size, and would turn a robot that then drives blind. Chosen by hand.
  double scales_learned_by_one_fix = 0.8;
  /// Survey, mount and floor are not perfect: an error that fixes share, beside what they say of their
  /// markers, as long as the robot stays about where it is and sees the same markers.
  double fix_sigma_floor_m = 0.002;
  double fix_sigma_floor_rad = radians(0.1);
  /// A body sways slowly on its floor, and the camera's tilt with it: fixes much nearer to each other in time
  /// than this have the same error, not two. How long was chosen: see
  /// variance_growth in belief_history.cpp.
  Duration fix_correlation = std::chrono::milliseconds(60);
};

/// Beliefs are kept for this long and older fixes refused: four times the age at which CameraWatch calls a
/// frame late.
inline constexpr Duration belief_history = std::chrono::seconds(1);

}  // namespace lodestar
