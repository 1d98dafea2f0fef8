#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "maps/random.hpp"
#include "maps/scan_rays.hpp"

// Scans of discs, for tests of what is seen of them.
namespace lodestar::testing {

struct ScanDisc {
  Vec2 center_m;
  double radius_m = 0.0;
};

inline constexpr double max_range_m = 8.0;

inline double range_to(const std::vector<ScanDisc>& discs, const Vec2& way) {
  double range_m = max_range_m;
  for (const ScanDisc& disc : discs) {
    const double along_m = disc.center_m.dot(way);
    const double aside_m = cross(disc.center_m, way);
    if (along_m > 0.0 && std::abs(aside_m) < disc.radius_m)
      range_m = std::min(range_m, along_m - std::sqrt(square(disc.radius_m) - square(aside_m)));
  }
  return range_m;
}

/// A scan from the origin of 720 beams, with 1.5 cm of range noise.
inline DeskewedScan scan_of(const std::vector<ScanDisc>& discs, double at_s, Random& random) {
  DeskewedScan scan{.newest = Stamp(from_seconds(at_s)), .rays = {}};
  for (int i = 0; i < 720; ++i) {
    const Vec2 way(std::cos(0.5 * radians(i)), std::sin(0.5 * radians(i)));
    double range_m = range_to(discs, way);
    const bool is_hit = range_m < max_range_m;
    if (is_hit) range_m += 0.015 * random.normal();
    scan.rays.push_back({scan.newest, Vec2::Zero(), range_m * way, is_hit ? Echo::hit : Echo::nothing});
  }
  return scan;
}

}  // namespace lodestar::testing
