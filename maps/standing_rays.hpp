#pragma once

#include <vector>

#include "maps/obstacle_memory.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

struct StandingRaysOptions {
  double joins_m = 0.15;        ///< neighbouring hits within this of each other are one thing
  double standing_share = 0.6;  ///< of a thing's hits, for any of them to count as standing
  /// What comes into sight of a thing as the robot goes around it, within a second: so far from what has
  /// stood it is the same thing, unless the floor was seen free there.
  double shows_m = 0.3;
};

/// For each ray of the newest scan that the memory has: does it end at something that stands? Of what is hit
/// in one piece a good part must stand: the flank of someone who walks across stays in the same cells for a
/// while.
[[nodiscard]] std::vector<bool> rays_at_what_stands(const DeskewedScan& scan, const ObstacleMemory& memory,
                                                    const StandingRaysOptions& options = {});

}  // namespace lodestar
