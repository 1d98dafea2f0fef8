#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/dots.hpp"

namespace lodestar {

struct MarkerAreaOptions {
  double dilation_px = 0.0;  ///< diameter of the disc that joins a marker's dots; 0: from the dots' spacing
  double join_pitches =
      3.6;  ///< dots nearer than this, in the pitch that their radius tells, become one area
  double max_size_ratio = 1.5;  ///< dots whose radii differ by more do not join
};

/// Dilation (paper, section 4.1, Fig. 2c): which dots grow together into one area. Two dots dilated by a disc
/// touch when their centres are nearer than its diameter, so no image has to be dilated. The disc comes from
/// the dots themselves, whose radius is a quarter of the pitch: dots of one marker are at most 3 pitches from
/// the next (O and X of ID 0), those of markers whose middles are 30 cm apart rarely as near. Keeps its
/// memory from frame to frame.
class MarkerAreaFinder {
 public:
  explicit MarkerAreaFinder(const MarkerAreaOptions& options = {}) : options_(options) {}

  /// How many areas there are, ordered by their first dot. What was found before is forgotten.
  std::size_t find(std::span<const Dot> dots);

  /// The dots of one area, in the order that they were given in.
  [[nodiscard]] std::span<const Dot> dots_of(std::size_t area) const;

 private:
  void join(std::span<const Dot> dots);

  MarkerAreaOptions options_;
  std::vector<std::size_t> order_;  ///< of the dots, from top to bottom
  DisjointSets sets_;
  std::vector<std::size_t> numbers_;
  std::vector<std::size_t> ends_;  ///< of the areas among the dots
  std::vector<Dot> dots_;          ///< area by area
};

}  // namespace lodestar
