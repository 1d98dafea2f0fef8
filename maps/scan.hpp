#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What came back of a beam. The three kinds without a range say different things: free floor, something
/// right here, and nothing at all.
enum class Echo : std::uint8_t {
  hit,       ///< something at `range_m`
  nothing,   ///< nothing up to the scan's `max_range_m`
  too_near,  ///< something nearer than the scanner can measure, its `min_range_m`
  invalid    ///< dirt, glare or a lost reading: nothing is known
};

struct Beam {
  Stamp stamp;             ///< when it was measured
  double angle_rad = 0.0;  ///< in the scanner frame, counter-clockwise from its x axis, (-pi, pi]
  double range_m = 0.0;    ///< of a hit
  float intensity = 0.0F;  ///< of a hit: 0 to 1 of what the scanner can express
  Echo echo = Echo::invalid;
};

/// One turn of a laser scanner. The beams are in the order in which they were measured.
struct Scan {
  std::vector<Beam> beams;
  double min_range_m = 0.0;
  double max_range_m = std::numeric_limits<double>::infinity();
};

/// What a scanner's driver made of its packets, since the beginning.
struct ScanPackets {
  std::uint64_t read = 0;
  std::uint64_t refused = 0;  ///< for their checksum, or for impossible content
};

/// Where a scanner sits on the robot: its beams lie in a plane parallel to the floor, `height_m` above it.
struct ScannerMount {
  Pose2 base_from_scanner;
  double height_m = 0.2;
};

}  // namespace lodestar
