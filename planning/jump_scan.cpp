#include "planning/jump_scan.hpp"

#include <bit>

namespace lodestar {
namespace {

constexpr int word_bits = 64;

/// Bits of cells at which a scan towards higher bits stops: the cell is not clear, or it is a jump point (the
/// cell beside it is clear and the one before that is not).
std::uint64_t stops_up(std::uint64_t line, std::uint64_t beside, std::uint64_t beside_before) {
  return ~line | (beside & ~((beside << 1U) | (beside_before >> 63U)));
}
std::uint64_t stops_down(std::uint64_t line, std::uint64_t beside, std::uint64_t beside_before) {
  return ~line | (beside & ~((beside >> 1U) | (beside_before << 63U)));
}

}  // namespace

BitLines::BitLines(int length, int lines)
    : words_a_line_((static_cast<std::size_t>(length) + 2U + 63U) / 64U),
      words_((static_cast<std::size_t>(lines) + 2U) * words_a_line_, 0) {}

int BitLines::jump_up(int line, int from) const {
  const std::uint64_t* const words = &words_[word(line, -1)];
  const std::uint64_t* const left = words - words_a_line_;
  const std::uint64_t* const right = words + words_a_line_;
  auto i = static_cast<std::size_t>(from + 1) / 64U;
  std::uint64_t after = ~std::uint64_t{1} << bit(from);  // only cells beyond the first
  for (;; ++i, after = ~std::uint64_t{0}) {
    const std::uint64_t stops = (stops_up(words[i], left[i], i > 0 ? left[i - 1] : 0) |
                                 stops_up(words[i], right[i], i > 0 ? right[i - 1] : 0)) &
                                after;
    if (stops == 0) continue;
    const int at = static_cast<int>(i) * word_bits + std::countr_zero(stops) - 1;
    return get(line, at) ? at - from : -(at - from - 1);
  }
}

int BitLines::jump_down(int line, int from) const {
  const std::uint64_t* const words = &words_[word(line, -1)];
  const std::uint64_t* const left = words - words_a_line_;
  const std::uint64_t* const right = words + words_a_line_;
  auto i = static_cast<std::size_t>(from + 1) / 64U;
  std::uint64_t before = (std::uint64_t{1} << bit(from)) - 1U;
  for (;; --i, before = ~std::uint64_t{0}) {
    const bool last = i + 1 == words_a_line_;
    const std::uint64_t stops = (stops_down(words[i], left[i], last ? 0 : left[i + 1]) |
                                 stops_down(words[i], right[i], last ? 0 : right[i + 1])) &
                                before;
    if (stops == 0) continue;
    const int at = static_cast<int>(i + 1) * word_bits - 1 - std::countl_zero(stops) - 1;
    return get(line, at) ? from - at : -(from - at - 1);
  }
}

JumpScan::JumpScan(const CollisionChecker& space)
    : columns_(space.columns()), rows_(space.rows()), by_row_(columns_, rows_), by_column_(rows_, columns_) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (!space.at({column, row})) continue;
      by_row_.set(row, column);
      by_column_.set(column, row);
    }
  }
}

NeighbourMask JumpScan::neighbours(Cell cell) const {
  unsigned mask = 0;
  for (std::size_t k = 0; k < grid_steps.size(); ++k) {
    const bool clear = by_row_.get(cell.row + grid_steps[k].row, cell.column + grid_steps[k].column);
    mask |= static_cast<unsigned>(clear) << k;
  }
  return static_cast<NeighbourMask>(mask);
}

int JumpScan::jump(Cell cell, int direction) const {
  switch (direction) {
    case 0:
      return by_row_.jump_up(cell.row, cell.column);
    case 2:
      return by_column_.jump_up(cell.column, cell.row);
    case 4:
      return by_row_.jump_down(cell.row, cell.column);
    case 6:
      return by_column_.jump_down(cell.column, cell.row);
    default:
      return diagonal_jump(cell, direction);
  }
}

int JumpScan::diagonal_jump(Cell cell, int direction) const {
  const Cell step = grid_steps[static_cast<std::size_t>(direction)];
  for (int steps = 0;; ++steps) {
    const Cell next{cell.column + step.column, cell.row + step.row};
    if (!by_row_.get(next.row, next.column) || !by_row_.get(cell.row, next.column) ||
        !by_row_.get(next.row, cell.column)) {
      return -steps;
    }
    cell = next;
    if (jump(cell, turned(direction, 1)) > 0 || jump(cell, turned(direction, -1)) > 0) return steps + 1;
  }
}

}  // namespace lodestar
