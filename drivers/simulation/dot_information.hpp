#pragma once

#include <Eigen/Core>

#include "drivers/simulation/disc_profile.hpp"
#include "drivers/simulation/projected_disc.hpp"

namespace lodestar {

/// What decides how well a disc's place can be told from a picture.
struct DiscImaging {
  double gray = 0.0;             ///< of the disc's middle, before noise
  double background_gray = 0.0;  ///< around it
  double blur_sigma_px = 0.0;    ///< lens and pixel together
  double read_noise_gray = 0.0;
  double shot_noise_gray_at_255 = 0.0;
};

/// Fisher's information of one noisy picture on the centre (u, v) of a disc, in 1/px^2: the sum over all
/// pixels of the squared slope of the noise-free picture (by finite differences of its painting) over the
/// variance of the pixel's noise, rounding to whole gray levels included. Brightness, radius and blur need
/// not be known: their slopes are even about the centre where those of the place are odd. Saturated pixels
/// tell nothing.
Eigen::Matrix2d information_on_center(const ProjectedDisc& disc, const DiscImaging& imaging,
                                      const DiscProfile& profile);

}  // namespace lodestar
