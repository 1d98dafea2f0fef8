#pragma once

#include <cstdint>
#include <vector>

#include "maps/marker.hpp"

// Distance between marker codes: the number of the grid's 16 cells that must be misread (a missed dot or a
// glint read as a dot) to confuse one marker with another.
namespace lodestar {

/// The cells that hold a dot, bit 4 row + column.
using MarkerPattern = std::uint16_t;

/// One of the eight symmetries of a square: first mirrored about the diagonal through O, then rotated by
/// quarter turns, counter-clockwise as the camera sees it.
struct MarkerView {
  int quarter_turns = 0;  ///< 0..3
  bool mirrored = false;
};

MarkerPattern pattern_of(int id, MarkerView view = {});

/// Hamming distance of the IDs, for two markers that are both read upright.
int id_distance(int a, int b);

/// Smallest number of cells that must be misread to confuse marker `a`, upright, with marker `b` in one of
/// the seven other views (rotated or mirrored). `a` may equal `b`. A rotation changes at least two corners
/// (the one opposite O is empty); mirroring about O's diagonal changes none, so an ID whose pattern is
/// symmetrical about that diagonal has distance 0 to itself.
int turned_distance(int a, int b);

/// Is turned_distance(a, b) 0? For very many pairs.
bool is_turned(int a, int b);

struct MarkerCodeOptions {
  int min_distance = 3;  ///< between any two chosen IDs
  int min_dots = 5;      ///< including O, X and Y; three or four dots are weak evidence of a marker
  /// Whether rotated and mirrored views count too. Then an ID also keeps its distance from those views of all
  /// other IDs and of itself. This excludes the 128 symmetrical IDs: when a camera driver mirrors its image,
  /// or a marker is printed mirrored, they would be read with the correct ID but with X and Y exchanged, and
  /// give a wrong pose instead of none.
  bool all_views = true;
  std::uint64_t seed = 1;
  int lexicodes = 10'000;  ///< tried at most; a second or two
};

/// IDs in ascending order, `count` of them or as many as were found, all at least the wanted distance from
/// each other and from those in `taken`. The same seed gives the same IDs.
///
/// Lexicodes: go through the 12-bit words in order and keep each that is far enough from all kept so far
/// (Conway and Sloane, "Lexicographic codes", 1986). With the order induced by any basis the result is a
/// linear code (Brualdi and Pless, "Greedy codes", 1993), and a constant added to all words avoids words with
/// few dots: 256 IDs at distance 3, 128 at distance 4 when views do not count. When they do, the size of the
/// code depends on the basis and the constant, and larger codes are found by hill climbing with restarts:
/// change basis or constant a little, keep the change if the code is no smaller, restart after a long time
/// without progress. It finds about 110 IDs at distance 3 and 64 at distance 4. The upper limits are 128 and
/// 72: together with their mirror images the IDs form a plain code twice as large.
std::vector<int> choose_marker_ids(int count, const std::vector<int>& taken,
                                   const MarkerCodeOptions& options);

/// IDs for a site, `count` of them or as many as there are: of a code as far apart in all views as `count`
/// allows, of a weaker one for larger sites.
std::vector<int> choose_marker_ids(int count, const std::vector<int>& taken);

}  // namespace lodestar
