#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "localization/detected_marker.hpp"
#include "localization/dots.hpp"
#include "localization/id_decoder.hpp"
#include "localization/marker_grid.hpp"

namespace lodestar {

struct CellEvidenceOptions {
  /// Log odds that a dot of the marker's size is one of its own, and that a cell as dark as the background is
  /// empty: one cell in 160,000 deceives (a dot that dirt covers wholly, a glint of a dot's size and place).
  double sure = 12.0;
  /// A cell without a dot is surely empty when it differs from the background by less than this share of the
  /// dots' contrast ...
  double dark_contrast = 0.06;
  /// ... and nothing can be said of it from here on.
  double unsure_contrast = 0.12;
};

/// Looks at every cell of a marker. A cell with one of the marker's dots is bright. One without must be seen,
/// and seen dark: the ID says as much by the dots it has not as by those it has. So a dot that is dirty, cut
/// by the border or lost in a lamp leaves its cell undecided.
CellEvidence look_at_cells(const cv::Mat& gray, const MarkerGrid& grid, std::span<const MarkerDot> in_cells,
                           std::span<const Dot> dots, const CellEvidenceOptions& options);

}  // namespace lodestar
