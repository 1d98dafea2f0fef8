#include "planning/regions.hpp"

#include <algorithm>
#include <bit>

namespace lodestar {

Regions::Regions(std::span<const std::uint64_t> words, int columns, int rows) {
  const std::size_t words_a_row = rows > 0 ? words.size() / static_cast<std::size_t>(rows) : 0;
  row_begins_.push_back(0);
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
    add_row(words.subspan(row * words_a_row, words_a_row), columns);
    if (row > 0) join_to_row_below(row);
  }
  for (std::uint32_t run = 0; run < runs_.size(); ++run) runs_[run].parent = root_of(run);
}

void Regions::add_row(std::span<const std::uint64_t> words, int columns) {
  int first = -1;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const int begin = static_cast<int>(i) * 64;
    // Bits that differ from the one before begin or end a run.
    std::uint64_t changes = words[i] ^ (words[i] << 1U | (first >= 0 ? 1U : 0U));
    for (; changes != 0; changes &= changes - 1) {
      const int at = begin + std::countr_zero(changes);
      if (first < 0) {
        first = at;
        continue;
      }
      runs_.push_back({first, at - 1, static_cast<std::uint32_t>(runs_.size())});
      first = -1;
    }
  }
  if (first >= 0) runs_.push_back({first, columns - 1, static_cast<std::uint32_t>(runs_.size())});
  row_begins_.push_back(static_cast<std::uint32_t>(runs_.size()));
}

void Regions::join_to_row_below(std::size_t row) {
  std::uint32_t below = row_begins_[row - 1];
  for (std::uint32_t run = row_begins_[row]; run < row_begins_[row + 1]; ++run) {
    while (below < row_begins_[row] && runs_[below].last < runs_[run].first) ++below;
    for (std::uint32_t i = below; i < row_begins_[row] && runs_[i].first <= runs_[run].last; ++i) {
      const std::uint32_t a = root_of(run);
      const std::uint32_t b = root_of(i);
      runs_[std::max(a, b)].parent = std::min(a, b);
    }
  }
}

std::uint32_t Regions::root_of(std::uint32_t run) {
  while (runs_[run].parent != run) {
    runs_[run].parent = runs_[runs_[run].parent].parent;
    run = runs_[run].parent;
  }
  return run;
}

int Regions::label(Cell cell) const {
  const auto row = static_cast<std::size_t>(cell.row);
  const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(row_begins_[row]);
  const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(row_begins_[row + 1]);
  const auto run = std::partition_point(begin, end, [&](const Run& each) { return each.last < cell.column; });
  return run != end && run->first <= cell.column ? static_cast<int>(run->parent) + 1 : 0;
}

}  // namespace lodestar
