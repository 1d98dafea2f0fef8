#pragma once

#include <cstdint>
#include <vector>

#include "planning/jump_table.hpp"

namespace lodestar {

/// Lines of cells as bits (1: clear), 64 to a word, padded with a blocked line before the first and after the
/// last, and a blocked bit at both ends of each line.
class BitLines {
 public:
  BitLines(int length, int lines);

  void set(int line, int at) { words_[word(line, at)] |= std::uint64_t{1} << bit(at); }
  [[nodiscard]] bool get(int line, int at) const { return ((words_[word(line, at)] >> bit(at)) & 1U) != 0; }

  /// Jumps along a line, as in JumpTable: 64 cells at a time.
  [[nodiscard]] int jump_up(int line, int from) const;
  [[nodiscard]] int jump_down(int line, int from) const;

 private:
  [[nodiscard]] static unsigned bit(int at) { return static_cast<unsigned>(at + 1) % 64U; }
  [[nodiscard]] std::size_t word(int line, int at) const {
    return static_cast<std::size_t>(line + 1) * words_a_line_ + static_cast<std::size_t>(at + 1) / 64U;
  }

  std::size_t words_a_line_;
  std::vector<std::uint64_t> words_;
};

/// The same jumps as JumpTable's, computed on demand on bit-packed rows and columns (the block scanning of
/// Harabor and Grastien 2014): a quarter of a byte per cell and hardly any set-up time, for a map used once
/// or changed often.
class JumpScan {
 public:
  explicit JumpScan(const CollisionChecker& space);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int jump(Cell cell, int direction) const;
  [[nodiscard]] NeighbourMask neighbours(Cell cell) const;
  void prefetch(Cell /*cell*/) const {}  ///< its bits are few enough to stay in the cache

 private:
  [[nodiscard]] int diagonal_jump(Cell cell, int direction) const;

  int columns_ = 0;
  int rows_ = 0;
  BitLines by_row_;
  BitLines by_column_;
};

}  // namespace lodestar
