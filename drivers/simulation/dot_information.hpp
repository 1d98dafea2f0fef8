#pragma once

#include <Eigen/Core>

#include "drivers/simulation/disc_profile.hpp"
#include "drivers/simulation/projected_disc.hpp"

namespace lodestar {

/// Appearance of a disc: determines how accurately its centre can be estimated from an image.
struct DiscImaging {
  double gray = 0.0;             ///< at the disc's centre, before noise
  double background_gray = 0.0;  ///< around it
  double blur_sigma_px = 0.0;    ///< lens and pixel together
  double read_noise_gray = 0.0;
  double shot_noise_gray_at_255 = 0.0;
};

/// Fisher information of one noisy image on the centre (u, v) of a disc, in 1/px^2: the sum over all pixels
/// of the squared derivative of the noise-free image (finite differences of the rendering) over the variance
/// of the pixel noise, which includes rounding to whole gray levels. Brightness, radius and blur need not be
/// known: their derivatives are even about the centre, those of the position odd. Saturated pixels carry no
/// information.
Eigen::Matrix2d information_on_center(const ProjectedDisc& disc, const DiscImaging& imaging,
                                      const DiscProfile& profile);

}  // namespace lodestar
