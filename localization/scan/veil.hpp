#pragma once

#include "maps/scan_rays.hpp"

namespace lodestar {

struct VeilOptions {
  double least_width_m = 0.12;  ///< of what must not be missed: a leg
  int least_beams = 3;          ///< that it takes, where a beam alone is nothing
  double joins_m = 0.15;        ///< neighbouring hits within this of each other are one thing
  /// Two beams alone that differ by so much in range meet nothing thin: 3 standard deviations of the
  /// difference and what the round edge of a leg adds.
  double depth_m = 0.05;
};

/// Calls invalid what one beam alone hits between what its neighbours hit: where a spot falls half on an edge
/// and half on what is behind it, a scanner reports a range between the two (mixed pixels, the veil behind
/// edges). And what two beams hit so far behind each other that they are not of one thing: through a gap the
/// second may have met what is behind. Only as near as a leg would take several beams.
DeskewedScan without_veils(DeskewedScan scan, const VeilOptions& options = {});

}  // namespace lodestar
