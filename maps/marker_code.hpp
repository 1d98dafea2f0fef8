#pragma once

#include <cstdint>
#include <vector>

#include "maps/marker.hpp"

// How far apart markers are: the number of the grid's 16 cells that must be misread, a dot lost or a glint
// won, to take one marker for another.
namespace lodestar {

/// The cells that hold a dot, bit 4 row + column.
using MarkerPattern = std::uint16_t;

/// One of the eight ways to lay a square on a square: mirrored about the diagonal through O first, then
/// turned by quarters, counter-clockwise as the camera sees it.
struct MarkerView {
  int quarter_turns = 0;  ///< 0..3
  bool mirrored = false;
};

MarkerPattern pattern_of(int id, MarkerView view = {});

/// Of two markers that are read upright: the Hamming distance of their IDs.
int id_distance(int a, int b);

/// Of marker a, upright, and marker b in any of the seven other views: how many cells must be misread at
/// least to take the one for the other, wrongly turned. `a` may be `b`. A turn changes two corners at least
/// (the one opposite O is empty), a mirror image about O's diagonal none: with it, an ID whose pattern is
/// symmetrical about that diagonal is at distance 0 of itself.
int turned_distance(int a, int b);

struct MarkerCodeOptions {
  int min_distance = 3;  ///< between all that are chosen
  int min_dots = 5;      ///< O, X and Y among them; three or four say little of whether they are a marker
  /// Do turned and mirrored views count too? Then an ID is also kept apart from the views of all others and
  /// of itself. That leaves out the 128 symmetrical IDs: when a camera's driver mirrors its image, or a
  /// marker is printed mirrored, they alone would be read as themselves with X and Y exchanged, and give a
  /// wrong pose instead of none.
  bool all_views = true;
  std::uint64_t seed = 1;
  int lexicodes = 10'000;  ///< tried at most; a second or two
};

/// IDs in ascending order, `count` of them or as many as were found, each at the wanted distance from each
/// other and from those in `taken`. The same seed gives the same IDs.
///
/// Lexicodes: take the words of 12 bits in order, keep each that is far enough from all kept (Conway and
/// Sloane, "Lexicographic codes", 1986). In the order that any basis gives, the result is linear (Brualdi and
/// Pless, "Greedy codes", 1993), and a constant added to all words moves it away from words with few dots:
/// 256 IDs at distance 3, 128 at distance 4 where views do not count. Where they do, bases and constants
/// differ in how many words they lead to, and those that lead to more are found by climbing: change one of
/// them a little, keep what is no worse, begin elsewhere when that has long brought nothing. It finds about
/// 110 IDs at distance 3 and 64 at distance 4. More than 128 and 72 cannot be: together with their mirror
/// images they make a plain code twice as large.
std::vector<int> choose_marker_ids(int count, const std::vector<int>& taken,
                                   const MarkerCodeOptions& options);

}  // namespace lodestar
