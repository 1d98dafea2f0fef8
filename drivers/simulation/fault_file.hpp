#pragma once

#include <filesystem>
#include <vector>

#include "drivers/simulation/fault.hpp"

namespace lodestar {

/// Reads a `format: lodestar-faults` file:
///
///     faults:
///       - {fault: camera_frozen, at_s: 6, for_s: 2}
///       - {fault: marker_moved, between_s: [4, 9], marker: 447, shift_m: 0.2,
///          direction_deg: 30, turn_deg: 0}
///
/// With `between_s` the begin is drawn from the seed; without `for_s` a fault lasts to the end; without
/// `marker` it affects the marker nearest to the robot when it begins (markers_occluded: all). Throws
/// InputError with file and line.
std::vector<Fault> load_faults(const std::filesystem::path& file);

}  // namespace lodestar
