#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "localization/detection/detected_marker.hpp"
#include "localization/detection/dots.hpp"
#include "localization/detection/id_decoder.hpp"
#include "localization/detection/marker_grid.hpp"

namespace lodestar {

struct CellEvidenceOptions {
  /// Log odds that a dot of the marker's size is one of its own, and that a cell as dark as the background is
  /// empty: one cell in 160,000 deceives (a dot that dirt covers wholly, a glint of a dot's size and place).
  double sure = 12.0;
  /// A cell without a dot is surely empty when its light differs from the background's by less than this
  /// share of a dot's ...
  double dark_contrast = 0.06;
  /// ... and nothing can be said of it from here on.
  double unsure_contrast = 0.12;
  /// Both are greater by this over the square of the dots' radius: few pixels are noisy, and the blurred
  /// edges of neighbours reach into them.
  double small_dot_contrast_px2 = 0.045;
  /// A dot whose radius is less than this share of the middle one of its marker's is covered in part.
  double whole_dot = 0.93;
  double whole_dot_tolerance_px2 = 0.1;  ///< over it: by so much less, for a small dot's is not known so well
};

/// Looks at every cell of a marker. A cell with one of the marker's dots is bright. One without must be seen,
/// and seen dark: the ID says as much by the dots it has not as by those it has. So a dot that is dirty, cut
/// by the border or lost in a lamp leaves its cell undecided.
CellEvidence evidence_of_cells(const cv::Mat& gray, const MarkerGrid& grid,
                               std::span<const MarkerDot> in_cells, std::span<const Dot> dots,
                               const CellEvidenceOptions& options);

/// How many of these dots lie within a marker's grid.
std::size_t dots_within(const MarkerGrid& grid, std::span<const Dot> dots);

/// Does something hang before this marker, or hang about it? What covers dots rarely covers them wholly: it
/// leaves slivers, which are dots within the grid that are none of the marker's, or dots that look too small.
bool shows_a_cover(const MarkerGrid& grid, std::span<const Dot> dots, std::span<const Dot> of_frame,
                   const CellEvidenceOptions& options);

}  // namespace lodestar
