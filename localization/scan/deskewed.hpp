#pragma once

#include <optional>

#include "localization/scan/own_outline.hpp"
#include "localization/scan/own_parts.hpp"
#include "localization/scan/wheel_track.hpp"
#include "maps/scan.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

/// The scan in the odometry frame, each beam from where the robot was when it was measured. Without those
/// that hit the robot itself, by geometry, in the directions of its own parts: a scanner's least range says
/// nothing about the robot around it, and who touches the robot is within its outline too.
/// Nothing when the wheels' readings do not cover the scan.
std::optional<DeskewedScan> deskewed(const Scan& scan, const ScannerMount& mount, const WheelTrack& track,
                                     const OwnOutline& own, const OwnParts& parts);

}  // namespace lodestar
