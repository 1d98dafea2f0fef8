#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "maps/scan_rays.hpp"

namespace lodestar {

/// Sizes of a person's legs at shin height, chosen by hand: generous, as a chair taken for legs costs only
/// room.
struct LegOptions {
  double within_m = 3.0;         ///< of the scanner: farther away the gap between two legs is not resolved
  double least_gap_m = 0.05;     ///< hits farther apart than this are not of one leg ...
  double gap_rad = 0.025;        ///< ... nor those farther apart than beams of half a degree leave them
  double widest_leg_m = 0.18;    ///< with trousers and the noise of the range
  double farthest_pair_m = 0.5;  ///< from middle to middle: standing, or in a stride
  /// What has nothing beside it so far behind is alone, but for a sliver of the leg that it hides, which has
  /// as much behind it: the posts of a row, seen along its side, show a sliver each. Of a leg that hides less
  /// of the other the gap between them opens before who passes can touch the body.
  double alone_before_m = 0.3;
  double sliver_m = 0.03;
  double perhaps_alone_before_m = 0.1;
  /// Rays that pass on the outer sides of a pair end so far behind: 3 standard deviations of the range.
  double aside_m = 0.05;

  /// How far apart neighbouring hits of one leg may end.
  [[nodiscard]] double gap_m(const Ray& ray) const { return std::max(least_gap_m, gap_rad * range_m(ray)); }
};

/// The rays that end at legs, of people or chairs: pairs of thin things close to each other, and thin things
/// alone, as a leg may hide the other. What they carry reaches farther out than they do.
struct RaysAtLegs {
  /// A thin part of a thing that is seen in one piece with others is no leg, nor is what sticks out of it.
  std::vector<std::size_t> likely;
  /// All that may be a leg, those above with it: parts of what stands in heaps look like that from most
  /// sides.
  std::vector<std::size_t> possible;
};
RaysAtLegs rays_at_legs(const DeskewedScan& scan, const LegOptions& options = {});

}  // namespace lodestar
