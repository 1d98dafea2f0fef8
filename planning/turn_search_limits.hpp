#pragma once

#include <cstddef>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// Relative saving of cost that is not worth another path.
inline constexpr double negligible_saving = 1e-9;
/// Dominance slack in seconds: a label is dropped when another one plus the turn between their headings is at
/// most this much slower.
inline constexpr double as_good_s = 0.3;

/// Work is counted in units of 3 to 5 ns: a leg looked at is one. A leg checked clear:
inline std::size_t work_of_check(double length_cells) {
  constexpr std::size_t least = 30;
  return least + static_cast<std::size_t>(length_cells);
}
inline constexpr std::size_t work_of_cost = 15;  ///< some legs and turns, their cost evaluated
inline constexpr std::size_t work_of_ray = 200;  ///< how far a ray is clear, found out

/// A clear path, and the work of finding it.
struct CountedPath {
  std::vector<Vec2> points;
  std::size_t work = 0;
};

/// Limits of one search in counts, not in time: the same query gives the same path on every machine.
struct TurnSearchLimits {
  /// Up to this many turn points that may lie on a cheaper path are all searched, with all arrival headings;
  /// not for `fastest` without clearance.
  std::size_t complete = 960;
  /// Else, this many are in each round.
  std::size_t candidates = 400;
  std::size_t work = 1500000;  ///< of one search
  /// `fastest` searches in rounds, each with other turn points: at most so many, and none after the first
  /// that would probably end above this work.
  int rounds = 6;
  std::size_t work_of_rounds = 1300000;
  /// Cells that the search for the cheapest path on the grid expands where cells cost differently, 0.1 us
  /// each; beyond them the shortest path is the first answer.
  std::size_t cells = 400000;
};

}  // namespace lodestar
