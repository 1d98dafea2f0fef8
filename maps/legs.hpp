#pragma once

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
};

/// The rays that end at what may be someone's legs, or those of a chair: pairs of thin things close to each
/// other, and thin things alone, as a leg may hide the other. What they carry reaches farther out than they
/// do.
std::vector<std::size_t> rays_at_legs(const DeskewedScan& scan, const LegOptions& options = {});

}  // namespace lodestar
