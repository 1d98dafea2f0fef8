#include "control/travel_time.hpp"

#include <algorithm>

namespace lodestar {

MotionLimits motion_limits(const DriveOptions& options) {
  return {
      .max_forward_mps = std::min(options.max_forward_mps, options.max_wheel_mps),
      .max_turn_radps = std::min(options.max_turn_radps, 2.0 * options.max_wheel_mps / options.track_width_m),
      .max_acceleration_mps2 = options.max_acceleration_mps2,
      .max_turn_acceleration_radps2 = options.max_turn_acceleration_radps2};
}

double ideal_travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                           std::optional<double> final_heading_rad, const DriveOptions& options) {
  return travel_time_s(path, start_heading_rad, final_heading_rad, motion_limits(options));
}

}  // namespace lodestar
