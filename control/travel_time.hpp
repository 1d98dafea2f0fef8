#pragma once

#include <optional>

#include "control/drive_options.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// The time a perfect robot takes for the path: at every waypoint at rest, turning on the spot, then straight
/// to the next, each with the time-optimal trapezoidal speed profile within the options' limits. Turns to and
/// from the given headings are added where there are such.
double ideal_travel_time_s(const Path& path, std::optional<double> start_heading_rad,
                           std::optional<double> final_heading_rad, const DriveOptions& options);

}  // namespace lodestar
