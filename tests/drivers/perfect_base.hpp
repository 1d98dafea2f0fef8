#pragma once

#include "drivers/simulation/simulated_base.hpp"

namespace lodestar {

/// A base whose only error is quantization.
inline SimulatedBaseOptions perfect_base() {
  SimulatedBaseOptions options;
  options.true_track_width_m = options.track_width_m;
  options.left_wheel_scale = 1.0;
  options.right_wheel_scale = 1.0;
  options.slip_sigma_per_sqrt_m = 0.0;
  return options;
}

}  // namespace lodestar
