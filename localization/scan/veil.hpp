#pragma once

#include "maps/scan_rays.hpp"

namespace lodestar {

struct VeilOptions {
  double least_width_m = 0.12;  ///< of what must not be missed: a leg
  int least_beams = 3;          ///< that it takes, where a beam alone is nothing
  double joins_m = 0.15;        ///< neighbouring hits within this of each other are one thing
};

/// Calls invalid what one beam alone hits between what its neighbours hit: where a spot falls half on an edge
/// and half on what is behind it, a scanner reports a range between the two (mixed pixels, the veil behind
/// edges). Only as near as a leg would take several beams.
DeskewedScan without_veils(DeskewedScan scan, const VeilOptions& options = {});

}  // namespace lodestar
