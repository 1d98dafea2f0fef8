#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// The 4-connected regions of the set cells of a bit map, as runs of cells in rows joined by union-find:
/// memory and time go with the number of runs.
class Regions {
 public:
  Regions() = default;
  /// `words`: a row's cells 64 to a word, row by row.
  Regions(std::span<const std::uint64_t> words, int columns, int rows);

  /// Cells of one region, and only those, have the same label; 0 for cells that are not set.
  [[nodiscard]] int label(Cell cell) const;

 private:
  struct Run {
    int first = 0;
    int last = 0;
    std::uint32_t parent = 0;  ///< a run of the same region; when all is joined, its first one
  };

  void add_row(std::span<const std::uint64_t> words, int columns);
  void join_to_row_below(std::size_t row);
  [[nodiscard]] std::uint32_t root_of(std::uint32_t run);

  std::vector<Run> runs_;
  std::vector<std::uint32_t> row_begins_;  ///< index of each row's first run, and one for the end
};

}  // namespace lodestar
