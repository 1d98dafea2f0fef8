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
  /// empty: one cell in 160,000 errs (a dot fully covered by dirt, a specular reflection of a dot's size and
  /// position).
  double sure = 12.0;
  /// A cell without a dot is decided to be empty when its light differs from the background's by less than
  /// this share of a dot's ...
  double dark_contrast = 0.06;
  /// ... and is undecided from this share on.
  double unsure_contrast = 0.12;
  /// Both grow by this over the square of the dots' radius: few pixels are noisy, and the blurred edges of
  /// neighbours reach into them.
  double small_dot_contrast_px2 = 0.045;
  /// A dot with a radius below this share of its marker's median is partly occluded.
  double whole_dot = 0.93;
  double whole_dot_tolerance_px2 = 0.1;  ///< less this over the median: small radii are less accurate
};

/// Evaluates every cell of a marker. A cell with one of the marker's dots is bright. One without must be
/// visible and dark: empty cells carry as much of the ID as dots. A dot that is dirty, cut by the border or
/// lost in a lamp leaves its cell undecided.
CellEvidence evidence_of_cells(const cv::Mat& gray, const MarkerGrid& grid,
                               std::span<const MarkerDot> in_cells, std::span<const Dot> dots,
                               const CellEvidenceOptions& options);

/// Number of these dots within a marker's grid.
std::size_t dots_within(const MarkerGrid& grid, std::span<const Dot> dots);

/// True with an occluder in front of or around this marker. Occluders rarely hide dots completely: they leave
/// slivers, which are dots within the grid that are not the marker's, or dots that look too small.
bool shows_a_cover(const MarkerGrid& grid, std::span<const Dot> dots, std::span<const Dot> of_frame,
                   const CellEvidenceOptions& options);

}  // namespace lodestar
