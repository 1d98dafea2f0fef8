#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "localization/detection/dots.hpp"
#include "localization/detection/inline_vector.hpp"
#include "localization/detection/marker_grid.hpp"

namespace lodestar {

/// A dot and its whole-numbered place on a lattice, `column` to the right and `row` down.
struct LatticeDot {
  std::size_t index = 0;  ///< of the dot
  int column = 0;
  int row = 0;
};

/// Without memory of their own.
using LatticeDots = InlineVector<LatticeDot, 24>;

struct LatticeOptions {
  std::size_t least_dots = 5;  ///< fewer always fit some lattice
  /// An area with more holds no single marker.
  std::size_t most_dots = LatticeDots::static_capacity;
  double size_tolerance = 0.25;   ///< how near 4 radii must be to a pitch, foreshortened or not
  double first_tolerance = 0.28;  ///< how far a dot may be from its place, in pitches, on the square lattice
  double tolerance = 0.12;        ///< and on the fitted one
  /// Of the ID read from it. One sure cell, as when a direction dot is covered, may contradict the reading,
  /// but then so many dots must support it.
  double least_probability = 0.99;
  int most_contradicting = 1;
  std::size_t least_dots_contradicted = 7;
  double least_cosine = 0.88;  ///< of the tilt: a lattice that is more oblong is none
};

/// A square lattice, seen tilted, that dots stand on. Which of its places are the marker's grid is open.
struct DotLattice {
  Vec2 origin_px = Vec2::Zero();  ///< place (0, 0)
  Vec2 column_px = Vec2::Zero();  ///< one place to the right
  Vec2 row_px = Vec2::Zero();     ///< one place down: a quarter clockwise in the image
  LatticeDots dots;               ///< at least `least_dots`, in a square of four by four
};

/// The lattice that most of the dots stand on, whatever stands between: glints do no harm, and no dot is
/// needed. Every pair of dots that may be neighbours in a row is tried as its base (Fischler and Bolles 1981,
/// with all samples). Nothing when too few agree.
std::optional<DotLattice> find_lattice(std::span<const Dot> dots, const LatticeOptions& options = {});

}  // namespace lodestar
