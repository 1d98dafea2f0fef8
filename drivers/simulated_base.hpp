#pragma once

#include "maps/motion.hpp"

namespace lodestar {

/// A differential base as it really is.
struct SimulatedBaseOptions {
  double track_width_m = 0.40;  ///< as the firmware believes
  double true_track_width_m = 0.404;
  double left_wheel_scale = 1.006;  ///< true travel over reported travel: unequal wheels
  double right_wheel_scale = 0.994;
  double slip_sigma_per_sqrt_m =
      0.002;                  ///< random loss or gain of ground per square root of metre rolled, each wheel
  double motor_lag_s = 0.08;  ///< first-order lag of the wheel speed loop
  double max_wheel_acceleration_mps2 = 2.0;
  double encoder_step_m = 0.0005;  ///< quantization of the wheel encoders
  Duration command_timeout = std::chrono::milliseconds(500);
  Duration feedback_period = std::chrono::milliseconds(20);
  Duration can_latency = std::chrono::milliseconds(1);
};

}  // namespace lodestar
