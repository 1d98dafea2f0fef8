#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/grid_step.hpp"

namespace lodestar {

/// Which of a cell's eight neighbours are clear: bit k for grid_steps[k].
using NeighbourMask = std::uint8_t;

/// Has the cell with these neighbours, reached by this straight step, a forced neighbour on this side? Then a
/// shortest path may have to turn here. Yes when the cell beside the step's beginning is not clear and that
/// beside its end is (Harabor and Grastien 2012, without corner cutting).
constexpr bool is_forced(int direction, NeighbourMask neighbours, int side_eighths) {
  const bool beside_end = ((neighbours >> turned(direction, side_eighths)) & 1) != 0;
  const bool beside_beginning =
      ((neighbours >> turned(direction, side_eighths + (side_eighths > 0 ? 1 : -1))) & 1) != 0;
  return beside_end && !beside_beginning;
}
constexpr bool is_jump_point(int direction, NeighbourMask neighbours) {
  return is_forced(direction, neighbours, 2) || is_forced(direction, neighbours, -2);
}

/// Bit k for grid_steps[k].
using DirectionSet = std::uint8_t;
inline constexpr unsigned all_directions = 0xff;

/// Directions to expand after arriving in `direction` (natural and forced neighbours): straight on; after a
/// diagonal step also its two straight directions; after a straight step also towards forced neighbours.
constexpr DirectionSet ways_on(int direction, NeighbourMask neighbours) {
  unsigned ways = 1U << direction;
  const auto add = [&](int eighths) { ways |= 1U << turned(direction, eighths); };
  if (is_diagonal(direction)) {
    add(1);
    add(-1);
    return static_cast<DirectionSet>(ways);
  }
  for (const int side : {2, -2}) {
    if (!is_forced(direction, neighbours, side)) continue;
    add(side);
    add(side / 2);
  }
  return static_cast<DirectionSet>(ways);
}

/// For every cell and direction: the number of steps to the next jump point; or, if an obstacle comes first,
/// minus the number of free steps up to it. Computed once per map in time linear in its cells (the JPS+ of
/// Harabor and Grastien 2014); 17 bytes per cell.
class JumpTable {
 public:
  explicit JumpTable(const CollisionChecker& space);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int jump(Cell cell, int direction) const {
    return jumps_[index(cell)][static_cast<std::size_t>(direction)];
  }
  [[nodiscard]] NeighbourMask neighbours(Cell cell) const { return neighbours_[index(cell)]; }
  /// Fetches what is asked of the cell when it is expanded, which is often next: on a large map it is not in
  /// the cache.
  void prefetch(Cell cell) const {
    __builtin_prefetch(&jumps_[index(cell)]);
    __builtin_prefetch(&neighbours_[index(cell)]);
  }

 private:
  [[nodiscard]] std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(cell.column);
  }
  void find_neighbours(const CollisionChecker& space);
  void fill(int direction);
  [[nodiscard]] std::int16_t jump_from(std::size_t cell, int direction) const;

  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::array<std::int16_t, 8>> jumps_;
  std::vector<NeighbourMask> neighbours_;
};

}  // namespace lodestar
