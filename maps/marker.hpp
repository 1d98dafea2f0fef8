#pragma once

#include <array>
#include <vector>

#include "maps/geometry.hpp"

// The ceiling marker: retroreflective dots on a 4 x 4 grid (paper, section 3 and Eq. (9)).
//
//   printed face, as the camera sees it from below          Q(row, column), hexadecimal
//
//     row 0   Y  .  .            Y top-left                   -   020 200  -
//     row 1   .  .  .  .         O bottom-left               002  010 100 800
//     row 2   .  .  .  .         X bottom-right              001  008 080 400
//     row 3   O  .  .  X         top-right always empty       -   004 040  -
//
// Marker frame: origin at the centre of dot O, x towards X, y towards Y, z out of the face (down).
namespace lodestar {

inline constexpr double marker_pitch_m = 0.04;
inline constexpr double marker_dot_radius_m = 0.01;
inline constexpr int marker_grid_size = 4;
inline constexpr int marker_id_count = 4096;

/// A cell of the grid; row 0 is the top one (Y's), column 0 the left one (O's and Y's).
struct GridCell {
  int row = 0;
  int column = 0;
  friend bool operator==(const GridCell&, const GridCell&) = default;
};

inline constexpr GridCell cell_of_o{3, 0};
inline constexpr GridCell cell_of_x{3, 3};
inline constexpr GridCell cell_of_y{0, 0};
inline constexpr GridCell cell_always_empty{0, 3};

/// The weight of a coded dot in the ID, Q of Eq. (9); 0 for the four corners.
constexpr int id_bit(GridCell cell) {
  constexpr std::array<std::array<int, 4>, 4> q{{{0x000, 0x020, 0x200, 0x000},
                                                 {0x002, 0x010, 0x100, 0x800},
                                                 {0x001, 0x008, 0x080, 0x400},
                                                 {0x000, 0x004, 0x040, 0x000}}};
  return q[static_cast<std::size_t>(cell.row)][static_cast<std::size_t>(cell.column)];
}

/// Is there a dot in this cell of the marker with this ID (0..4095)?
constexpr bool has_dot(int id, GridCell cell) {
  return cell == cell_of_o || cell == cell_of_x || cell == cell_of_y || (id & id_bit(cell)) != 0;
}

/// Centre of a cell in the marker frame's plane.
inline Vec2 cell_in_marker(GridCell cell) {
  return marker_pitch_m * Vec2(cell.column, marker_grid_size - 1 - cell.row);
}

/// All cells that hold a dot, row by row; 3 to 15 of them.
std::vector<GridCell> dots_of(int id);

}  // namespace lodestar
