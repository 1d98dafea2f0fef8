#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/detected_marker.hpp"
#include "localization/detection/dots.hpp"
#include "localization/detection/inline_vector.hpp"
#include "localization/detection/marker_grid.hpp"

namespace lodestar {

/// How much tilt, perspective and noise a marker may show. The code has no redundancy: whatever does not fit
/// is refused, for a marker not read costs a frame and a marker misread costs the pose.
struct MarkerDecoderOptions {
  double most_tilt_rad = radians(36.0);  ///< of the marker to the image, by how much it is foreshortened
  std::size_t least_dots_for_tilt = 5;   ///< fewer would fit too many grids: they are few
  double most_tilt_of_few_rad = radians(14.0);
  double alike_tolerance = 0.1;  ///< how alike the dots' radii must be, as a share of them,
  /// and besides, over them: neighbours shine into the ring that tells a small dot's background, more on one
  /// among many.
  double alike_tolerance_px2 = 0.4;
  double small_dot_tolerance_px = 0.12;  ///< by so much a dot of a few pixels may look too small
  double cell_tolerance =
      0.2;  ///< how far a dot may be from its cell, in pitches, before perspective is known
  double fit_tolerance = 0.08;  ///< and after
  double size_tolerance = 0.2;  ///< how near 4 radii must be to a pitch
  /// By so much more a dot may look too large: saturated, or so small that blur dims its middle, by which its
  /// radius is told. Three or four dots two pitches apart that are taken for O, X and Y make theirs too large
  /// by half, and by more than few are allowed; five such dots fit no grid.
  double growth_px = 0.8;
  double growth_of_few_px = 0.35;
  double guard_pitches = 2.0;  ///< about a marker that shares its area with others, so much must be clear
  std::size_t least_dots_in_a_crowd = 5;  ///< and so many dots agree: three always fit some grid
  std::size_t most_dots = 48;             ///< an area with more holds no markers
  bool every_corner = true;               ///< try every dot as O where the paper's rule finds no marker
};

/// The direction dots, as indices.
struct DirectionDots {
  std::size_t o = 0;
  std::size_t x = 0;
  std::size_t y = 0;
};

/// The paper's rule (4.2.1): A and B are the two dots farthest apart, O is the one farthest from their middle
/// (A and B, as far from it as O, are out of the question). Right for every ID that is tilted by less than 32
/// degrees in the middle of the image, because the corner opposite O is always empty. Which of A and B is X
/// is told by the turn from OX to OY, Eq. (4) and (5): counter-clockwise on the face as printed. Nothing for
/// fewer than three dots.
std::optional<DirectionDots> direction_dots(std::span<const Dot> dots);

/// The ID that these cells' dots stand for, Eq. (9).
int id_of(std::span<const MarkerDot> dots);

/// Of a marker's dots among others.
using MarkerDotIndices = InlineVector<std::size_t, MarkerDots::static_capacity>;

/// A marker read from dots.
struct MarkerReading {
  int id = 0;
  MarkerGrid grid;
  MarkerDots dots;
  MarkerDotIndices indices;  ///< of the same dots among those given
};

/// Reads dots that are all of one marker: each must stand in a cell of its own, and none in the corner
/// opposite O. Nothing when any of them does not fit. A mirrored print shows exactly the dots of another
/// marker, the one whose ID is transposed (Q mirrored about the diagonal through O), and is read as that one:
/// no reader of dots can tell.
std::optional<MarkerReading> read_marker(std::span<const Dot> dots, const DirectionDots& direction,
                                         const MarkerDecoderOptions& options = {});

/// Reads all markers of one dilated area. As a rule it holds one, which the paper's rule reads; when that
/// fails (markers too near each other, a glint beside one, a steep view) every dot is tried as O. Two
/// readings that share a dot are both refused. Keeps its memory from area to area.
class AreaReader {
 public:
  explicit AreaReader(const MarkerDecoderOptions& options = {}) : options_(options) {}

  /// The result holds until the next call.
  std::span<const MarkerReading> read(std::span<const Dot> dots);

 private:
  void read_every_corner(std::span<const Dot> dots);
  void reject_conflicts();
  void read_the_rest(std::span<const Dot> dots);

  MarkerDecoderOptions options_;
  std::vector<MarkerReading> tried_;
  std::vector<MarkerReading> readings_;
  std::vector<std::size_t> ends_;  ///< of axes from one O
  std::vector<Dot> rest_;
  std::vector<std::size_t> rest_indices_;
};

}  // namespace lodestar
