#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "localization/detection/detected_marker.hpp"
#include "localization/detection/dot.hpp"
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
  /// Where the ceiling is not even, a cell is judged by the light above it only if at least this share of it,
  /// within `inner_radii`, is at the ceiling's level. As much of a dot would show as light.
  double inner_radii = 0.85;
  double least_in_view = 0.2;
  /// Or if a dark line passes through it that is the ceiling's: so many of the marker's dots have lines
  /// behind them. Lines lie behind dots, and a cover wide enough to hide one has no ceiling on both sides.
  int least_dots_on_lines = 1;
  double line_radii = 2.2;  ///< a line is looked for up to here: the next dot's edge is at 3
  double side_radii = 1.4;  ///< beyond a dot's blurred edge the ceiling is seen beside it
  /// At its level: off by less than `dark_contrast` or these sigmas of the noise, ...
  double level_noise_sigmas = 3.0;
  /// ... plus so many standard deviations of the level from dot to dot.
  double level_spreads = 1.5;
  /// Dots nearer than this many sigmas of their light, seen as Gaussians, may shine into a cell.
  double neighbour_sigmas = 4.5;
  double ring_radii =
      1.9;  ///< ring around a cell that tells the ceiling's level: up to half the next dot's way
  /// A dot with a radius below this share of its marker's median is partly occluded.
  double whole_dot = 0.93;
  double whole_dot_on_structure = 0.8;   ///< the same where the ceiling around it is uneven
  double whole_dot_tolerance_px2 = 0.1;  ///< less this over the median: small radii are less accurate
};

/// Evaluates every cell of a marker. A cell with one of the marker's dots is bright. One without must be
/// visible and as dark as the ceiling: empty cells carry as much of the ID as dots. A dark line through a
/// cell is the ceiling's, not a cover. A dot that is dirty, cut by the border or lost in a lamp leaves its
/// cell undecided. `noise_gray` is the noise of a pixel in the dark.
CellEvidence evidence_of_cells(const cv::Mat& gray, const MarkerGrid& grid,
                               std::span<const MarkerDot> in_cells, std::span<const Dot> dots,
                               double noise_gray, const CellEvidenceOptions& options);

/// Number of these dots within a marker's grid.
std::size_t dots_within(const MarkerGrid& grid, std::span<const Dot> dots);

/// True with an occluder in front of or around this marker. Occluders rarely hide dots completely: they leave
/// slivers, which are dots within the grid that are not the marker's, or dots that look too small.
bool shows_a_cover(const MarkerGrid& grid, std::span<const Dot> dots, std::span<const Dot> of_frame,
                   const CellEvidenceOptions& options);

}  // namespace lodestar
