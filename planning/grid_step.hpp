#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <numbers>

#include "maps/occupancy_map.hpp"

// Steps on the 8-connected grid. A diagonal step needs both cells beside it to be clear: no corner is cut.
namespace lodestar {

/// The eight directions counter-clockwise from the grid's x axis; even ones are straight, odd ones diagonal.
inline constexpr std::array<Cell, 8> grid_steps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

constexpr int turned(int direction, int eighths) {
  return (direction + eighths) & 7;
}
constexpr bool is_diagonal(int direction) {
  return (direction & 1) != 0;
}

/// The direction from one cell to another in the same row, column or diagonal.
constexpr int direction_between(Cell from, Cell to) {
  constexpr std::array<std::array<int, 3>, 3> by_sign{{{5, 6, 7}, {4, 0, 0}, {3, 2, 1}}};
  const auto sign = [](int value) { return static_cast<std::size_t>(value > 0 ? 2 : value < 0 ? 0 : 1); };
  return by_sign[sign(to.row - from.row)][sign(to.column - from.column)];
}

/// Path length in fixed point: a straight and b diagonal steps are a + b sqrt(2). With 40 fractional bits two
/// different counts keep their order up to millions of steps, sums are exact, and equality is exact.
using StepLength = std::int64_t;
inline constexpr StepLength straight_length = StepLength{1} << 40U;
inline constexpr StepLength diagonal_length =
    static_cast<StepLength>(std::numbers::sqrt2 * static_cast<double>(straight_length) + 0.5);

/// Number of steps of a path; its length is exact to the last bit of a double.
struct StepCount {
  int straight = 0;
  int diagonal = 0;
  [[nodiscard]] double length_cells() const { return straight + diagonal * std::numbers::sqrt2; }
};

/// The fewest steps between two cells without obstacles (the octile distance).
inline StepCount free_steps(Cell from, Cell to) {
  const int across = std::abs(to.column - from.column);
  const int up = std::abs(to.row - from.row);
  return across > up ? StepCount{across - up, up} : StepCount{up - across, across};
}
inline StepLength free_length(Cell from, Cell to) {
  const StepCount steps = free_steps(from, to);
  return steps.straight * straight_length + steps.diagonal * diagonal_length;
}

}  // namespace lodestar
