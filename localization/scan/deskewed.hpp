#pragma once

#include <optional>

#include "localization/scan/wheel_track.hpp"
#include "maps/robot_shape.hpp"
#include "maps/scan.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

/// What the scanner is mounted on, as far as it sees it.
struct OwnOutline {
  RobotShape shape;
  /// Hits this near to the outline, or inside it, are the robot itself: 2 standard deviations of the range of
  /// a cheap scanner (1.5 cm).
  double margin_m = 0.03;
};

/// The scan in the odometry frame, each beam from where the robot was when it was measured. Without those
/// that hit the robot itself, by geometry: a scanner's least range says nothing about the robot around it.
/// Nothing when the wheels' readings do not cover the scan.
std::optional<DeskewedScan> deskewed(const Scan& scan, const ScannerMount& mount, const WheelTrack& track,
                                     const OwnOutline& own);

}  // namespace lodestar
