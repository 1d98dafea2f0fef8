#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "localization/detection/dot.hpp"
#include "localization/detection/inline_vector.hpp"
#include "localization/detection/marker_grid.hpp"

namespace lodestar {

/// A dot and its integer position on a lattice, `column` to the right and `row` down.
struct LatticeDot {
  std::size_t index = 0;  ///< of the dot
  int column = 0;
  int row = 0;
};

/// Stored inline.
using LatticeDots = InlineVector<LatticeDot, 24>;

struct LatticeOptions {
  std::size_t least_dots = 5;  ///< fewer always fit some lattice
  /// An area with more dots is not a single marker.
  std::size_t most_dots = LatticeDots::static_capacity;
  double size_tolerance = 0.25;   ///< relative mismatch of 4 radii and a pitch, foreshortened or not
  double first_tolerance = 0.28;  ///< largest distance of a dot from the square lattice, in pitches
  double tolerance = 0.12;        ///< and on the fitted one
  /// Posterior of the ID read from it. One decided cell may contradict the reading, as when a direction dot
  /// is occluded, but then at least `least_dots_contradicted` dots must support it.
  double least_probability = 0.99;
  int most_contradicting = 1;
  std::size_t least_dots_contradicted = 7;
  double least_cosine = 0.88;  ///< of the tilt: a more oblong lattice is rejected
};

/// A square lattice through the dots, seen tilted. Which of its places are the marker's grid is undecided.
struct DotLattice {
  Vec2 origin_px = Vec2::Zero();  ///< place (0, 0)
  Vec2 column_px = Vec2::Zero();  ///< one place to the right
  Vec2 row_px = Vec2::Zero();     ///< one place down: a quarter turn clockwise in the image
  LatticeDots dots;               ///< at least `least_dots`, in a square of four by four
};

/// The lattice through the most dots: outliers such as specular reflections do no harm, and no particular dot
/// is needed. Every pair of dots that may be in one row is tried as its base (RANSAC, Fischler and Bolles
/// 1981, with all samples). Nothing when too few agree.
std::optional<DotLattice> find_lattice(std::span<const Dot> dots, const LatticeOptions& options = {});

}  // namespace lodestar
