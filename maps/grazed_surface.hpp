#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "maps/scan_rays.hpp"

namespace lodestar {

struct GrazedSurfaceOptions {
  double joins_m = 0.4;         ///< ends farther apart are of different things
  double least_length_m = 0.3;  ///< to know which way it leads
  double least_cosine = 0.97;   ///< between it and a ray that grazes it: 14 degrees
  /// Beside the way that it leads: posts that touch are rough, and the range's noise tilts the way.
  double off_m = 0.03;
};

/// What neighbouring rays have hit so far, one after the other. The more they graze it, the farther apart
/// they end: from 5 cm beside a wall, 30 cm at a metre and a half.
class GrazedSurface {
 public:
  explicit GrazedSurface(const GrazedSurfaceOptions& options = {}) : options_(options) {}

  /// Does the next ray graze it and end where it leads on?
  [[nodiscard]] bool leads_to(const Ray& ray) const;

  /// The next ray has hit it here. Too far away, another one begins.
  void add(const Vec2& end_m);

  void end() { ends_m_.clear(); }

 private:
  GrazedSurfaceOptions options_;
  std::vector<Vec2> ends_m_;
};

/// Is what the rays, which are neighbours, hit deeper than it looks wide, as what they graze is? Of a single
/// one that is not known: then true.
[[nodiscard]] bool are_grazing(const DeskewedScan& scan, std::span<const std::size_t> rays);

}  // namespace lodestar
