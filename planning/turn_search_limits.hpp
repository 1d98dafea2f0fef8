#pragma once

#include <cstddef>

namespace lodestar {

/// Relative saving of cost that is not worth another path.
inline constexpr double negligible_saving = 1e-9;
/// Dominance slack in seconds: a label is dropped when another one plus the turn between their headings is at
/// most this much slower.
inline constexpr double as_good_s = 0.3;

/// Limits of one search in counts, not in time: the same query gives the same path on every machine.
struct TurnSearchLimits {
  /// Up to this many turn points that may lie on a cheaper path are all searched, with all arrival headings.
  std::size_t complete = 960;
  /// Where there are more, this many are in each round.
  std::size_t candidates = 240;
  /// Work units: 1 for a leg looked at, 30 and its length in cells for one checked clear. 3 to 5 ns each.
  std::size_t work = 1500000;
  /// `fastest` searches in rounds, each with other turn points: at most so many, and none after the first
  /// that would probably end above this work.
  int rounds = 4;
  std::size_t work_of_rounds = 500000;
  /// Cells that the search for the cheapest path on the grid expands where cells cost differently, 0.1 us
  /// each; beyond them the shortest path is the first answer.
  std::size_t cells = 400000;
};

}  // namespace lodestar
