#pragma once

#include "drivers/simulation/ceiling_kind.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Image formation and timing of the simulated camera. Gray values are on the 8-bit scale, before noise.
struct SimulatedCameraOptions {
  Duration period = std::chrono::milliseconds(50);   ///< from the start of one exposure to the next
  Duration latency = std::chrono::milliseconds(45);  ///< from mid-exposure to arrival
  Duration exposure = std::chrono::milliseconds(4);  ///< motion blur while the robot moves
  double dot_gray = 246.0;  ///< at a dot's centre on the axis; 246 is ordinary light, 120..200 is difficult
  double dot_gray_sigma = 2.0;  ///< from dot to dot
  /// Placement error of a dot in the marker, in each coordinate: film is cut and glued by hand.
  double dot_place_sigma_m = 0.00005;
  double marker_tilt_sigma_rad = 0.0;  ///< of a marker on the ceiling, about each horizontal axis
  double print_scale = 1.0;            ///< true size of the printed markers over the nominal one
  CeilingKind ceiling = CeilingKind::tiles;
  double background_gray = 35.0;        ///< of the bare ceiling on the axis; ambient light raises it
  double blur_sigma_px = 0.5;           ///< point spread of the lens, without the pixel's own area
  double read_noise_gray = 1.5;         ///< standard deviation in the dark
  double shot_noise_gray_at_255 = 4.0;  ///< grows with the square root of the signal
  double vignetting = 0.3;              ///< loss of light in the corners
  double texture_gray = 6.0;            ///< amplitude of the texture of tiles; other kinds have their own
  double tilt_sigma_rad = 0.002;        ///< body sway (roll and pitch), each axis
  bool tubes = true;                    ///< fluorescent tubes on the ceiling, as in Fig. 2
  bool lamps = true;
  bool glints = true;
  double lost_frame_probability = 0.01;
};

}  // namespace lodestar
