#pragma once

#include <chrono>
#include <functional>

#include "localization/survey/wheel_segment.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// What the robot file says of the robot, and how far that may be off (standard deviations).
struct SurveyBelief {
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();  ///< its height is kept
  double track_width_m = 0.4;
  double lean_sigma_rad = radians(0.2);  ///< of the body on the floor, about each of two axes
  WheelNoise wheels;
};

/// Which frames are used, and what is known beforehand of things that nobody measures.
struct SurveyOptions {
  double spacing_m = 0.15;            ///< a keyframe after this way ...
  double spacing_rad = radians(8.0);  ///< ... or this turn: closer ones see the same errors again
  Duration spacing_time = std::chrono::milliseconds(300);  ///< where there are no wheel readings
  std::size_t most_keyframes = 4000;                       ///< of all logs; farther apart then
  int least_dots = 4;                                      ///< of a marker in a frame; three fit any lean

  double dot_sigma_px = 0.03;        ///< of dots that do not say theirs
  double least_dot_sigma_px = 0.01;  ///< what no detector is better than on real frames: a lens is no formula
  double dot_place_sigma_m = 5e-5;   ///< of a dot in its marker: film is cut by a machine, glued by hand
  double marker_tilt_sigma_rad = radians(1.5);  ///< of a marker on an uneven, perhaps inclined ceiling
  double lens_sigma = 0.003;                    ///< of k1, which differs with temperature and focus
  double mount_sigma_m = 0.05;
  double mount_tilt_sigma_rad = radians(2.0);
  double mount_yaw_sigma_rad = radians(5.0);
  double ceiling_sigma = 0.1;  ///< of the ceiling's height over the camera, relative, for its own motion
  double wheel_sigma = 0.03;   ///< of the wheels' scale, their difference and the track width, relative

  std::size_t least_sightings = 3;           ///< keyframes of a marker
  double most_sigma_m = 0.02;                ///< of a marker's x or y
  double most_scale_sigma = 0.005;           ///< relative; beyond it the scale is unknown
  double most_yaw_sigma_rad = radians(1.0);  ///< of the whole registry on the map
  double most_dots_factor = 2.0;             ///< what fits leave of the dots over what they should (chi2/dof)
  double most_marker_factor = 4.0;           ///< the same of one marker's
  double most_wheels_factor = 50.0;          ///< the same of the wheels: floors differ
  double least_probability = 1e-4;           ///< of what anchors leave; what is likelier widens the sigmas
  int most_iterations = 60;
  std::function<void()> before_covariance;  ///< called once between the two long steps, for who times them
};

}  // namespace lodestar
