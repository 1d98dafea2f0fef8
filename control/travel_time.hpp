#pragma once

#include <optional>

#include "control/drive_options.hpp"
#include "maps/motion.hpp"
#include "maps/travel_time.hpp"

namespace lodestar {

/// The tighter of the body's and the wheels' limits.
MotionLimits motion_limits(const DriveOptions& options);

/// travel_time_s() within those limits.
double ideal_travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                           std::optional<double> final_heading_rad, const DriveOptions& options);

}  // namespace lodestar
