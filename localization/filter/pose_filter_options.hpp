#pragma once

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct PoseFilterOptions {
  double track_width_m = 0.4;  ///< between the wheels' contact points, as built
  /// Random error of one wheel's travel, per square root of metre rolled.
  double wheel_noise_m_per_sqrt_m = 0.002;
  double wheel_step_m = 0.001;              ///< readings of a wheel's travel are rounded to it
  double initial_wheel_scale_sigma = 0.02;  ///< how unequal the wheels may be before anything is learned
  double initial_turn_scale_sigma = 0.02;   ///< how wrong the track width may be before anything is learned
  double wheel_scale_drift_per_sqrt_m = 0.0003;  ///< how fast these scales may change
  /// Of what one fix says about these scales only this share is taken: a rare jerk of a wheel between two
  /// fixes looks like wheels of unequal size, and would turn a robot that then drives blind.
  double scales_learned_by_one_fix = 0.8;
  /// Survey, mount and floor are not perfect: an error that fixes share, beside what they say of their
  /// markers, as long as the robot stays about where it is and sees the same markers. It is another one after
  /// rolling `fix_bias_reach_m`.
  double fix_sigma_floor_m = 0.002;
  double fix_sigma_floor_rad = radians(0.1);
  double fix_bias_reach_m = 1.0;
  /// A body sways slowly on its floor, and the camera's tilt with it: fixes much nearer to each other in time
  /// than this have the same error, not two. Chosen by the NEES of simulated drives.
  Duration fix_correlation = std::chrono::milliseconds(60);
  int fixes_to_start = 2;     ///< consecutive consistent fixes that a start takes
  int fixes_to_relocate = 5;  ///< consecutive refused fixes that agree among themselves and move the estimate
  /// Nearer than this, the fixes that move the estimate must rest on two markers or more: one that hangs
  /// elsewhere than surveyed contradicts steadily too.
  double relocation_by_one_marker_m = 0.7;
  /// Where so many pictures of the ceiling in a row contradict the wheels, their agreement is worth nothing
  /// until a fix agrees: one of the two is wrong.
  int motions_refused_to_doubt = 2;
  Duration standing_after = std::chrono::milliseconds(300);  ///< without travel
  Duration history = std::chrono::seconds(1);                ///< fixes older than this are refused
  /// And those newer than the wheels' last word by more than this.
  Duration max_ahead = std::chrono::milliseconds(100);
};

}  // namespace lodestar
