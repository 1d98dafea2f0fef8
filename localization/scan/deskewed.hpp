#pragma once

#include <optional>
#include <span>
#include <vector>

#include "localization/scan/own_outline.hpp"
#include "localization/scan/own_parts.hpp"
#include "localization/scan/wheel_track.hpp"
#include "maps/scan.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

/// Where the robot was as each beam was measured (odom_from_base). Nothing when the scan has no beams or the
/// wheels' readings do not cover it.
std::optional<std::vector<Pose2>> poses_during(const Scan& scan, const WheelTrack& track);

/// The scan in the odometry frame, each beam from where the robot was when it was measured. Without those
/// that hit the robot itself, by geometry, in the directions of its own parts: a scanner's least range says
/// nothing about the robot around it, and who touches the robot is within its outline too. `odom_from_base`
/// is what poses_during says of this scan.
DeskewedScan deskewed(const Scan& scan, const ScannerMount& mount, std::span<const Pose2> odom_from_base,
                      const OwnOutline& own, const OwnParts& parts);

}  // namespace lodestar
