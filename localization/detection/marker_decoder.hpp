#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/detected_marker.hpp"
#include "localization/detection/dot.hpp"
#include "localization/detection/inline_vector.hpp"
#include "localization/detection/marker_grid.hpp"

namespace lodestar {

/// Limits of tilt, perspective and noise. The code has no redundancy, so whatever does not fit is rejected: a
/// missed marker costs a frame, a misread one the pose.
struct MarkerDecoderOptions {
  double most_tilt_rad = radians(36.0);  ///< between marker and image, from the foreshortening
  std::size_t least_dots_for_tilt = 5;   ///< fewer fit too many grids: the limits `of_few` apply
  double most_tilt_of_few_rad = radians(14.0);
  /// Largest difference of the dots' radii, relative to the smallest, ...
  double alike_tolerance = 0.1;
  /// ... plus this over it: neighbours brighten the ring that gives a small dot's background, more so for one
  /// among many.
  double alike_tolerance_px2 = 0.4;
  double alike_on_structure = 0.3;       ///< in place of `alike_tolerance` when one of them lies on structure
  double small_dot_tolerance_px = 0.12;  ///< a dot of a few pixels may look too small by this
  /// Largest distance of a dot from its cell, in pitches, before the perspective is known,
  double cell_tolerance = 0.2;
  double fit_tolerance = 0.08;  ///< and after
  double size_tolerance = 0.2;  ///< relative mismatch of 4 radii and a pitch
  /// A dot may look larger by this: when saturated, or so blurred that its middle is dimmed, from which its
  /// radius is derived (a disc of radius 2 px behind a blur of 2.5 px looks twice as large). Three or four
  /// dots two pitches apart that are mistaken for O, X and Y look too large by half, more than few dots are
  /// allowed; five such dots fit no grid.
  double growth_px = 3.0;
  double growth_of_few_px = 0.35;
  double guard_pitches = 2.0;             ///< must be clear around a marker that shares its area with others
  std::size_t least_dots_in_a_crowd = 5;  ///< and so many dots must agree: three always fit some grid
  std::size_t most_dots = 48;             ///< an area with more holds no markers
  bool every_corner = true;               ///< try every dot as O where the paper's rule finds no marker
};

/// Indices of the direction dots.
struct DirectionDots {
  std::size_t o = 0;
  std::size_t x = 0;
  std::size_t y = 0;
};

/// The paper's rule (4.2.1): A and B are the two dots farthest apart, O is the one farthest from their
/// midpoint (excluding A and B, which are as far from it as O). Correct for every ID at a tilt below 32
/// degrees in the middle of the image, because the corner opposite O is always empty. The sign of the turn
/// from OX to OY, Eq. (4) and (5), tells which of A and B is X: counter-clockwise on the face as printed.
/// Nothing for fewer than three dots.
std::optional<DirectionDots> direction_dots(std::span<const Dot> dots);

/// The ID of these dots' cells, Eq. (9).
int id_of(std::span<const MarkerDot> dots);

/// Indices of a marker's dots among others.
using MarkerDotIndices = InlineVector<std::size_t, MarkerDots::static_capacity>;

/// A marker read from dots.
struct MarkerReading {
  int id = 0;
  MarkerGrid grid;
  MarkerDots dots;
  MarkerDotIndices indices;  ///< of the same dots in the input
};

/// Reads dots that all belong to one marker: each must be in a cell of its own, and none in the corner
/// opposite O. Nothing when any of them does not fit. A mirrored print shows exactly the dots of the marker
/// with the transposed ID (Q mirrored about the diagonal through O) and is read as that one: dots alone
/// cannot tell them apart.
std::optional<MarkerReading> read_marker(std::span<const Dot> dots, const DirectionDots& direction,
                                         const MarkerDecoderOptions& options = {});

/// Reads all markers of one dilated area. Usually it holds one, which the paper's rule reads; when that fails
/// (markers too close, a specular reflection beside one, a steep view) every dot is tried as O. Two readings
/// that share a dot are both rejected. Reuses its buffers from area to area.
class AreaReader {
 public:
  explicit AreaReader(const MarkerDecoderOptions& options = {}) : options_(options) {}

  /// The result is valid until the next call.
  std::span<const MarkerReading> read(std::span<const Dot> dots);

 private:
  void read_every_corner(std::span<const Dot> dots);
  void reject_conflicts();
  void read_the_rest(std::span<const Dot> dots);

  MarkerDecoderOptions options_;
  std::vector<MarkerReading> tried_;
  std::vector<MarkerReading> readings_;
  std::vector<std::size_t> ends_;  ///< candidate axis ends for one O
  std::vector<Dot> rest_;
  std::vector<std::size_t> rest_indices_;
};

}  // namespace lodestar
