#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/dot.hpp"

namespace lodestar {

struct MarkerAreaOptions {
  double dilation_px = 0.0;  ///< diameter of the dilating disc; 0: from the dots' radius
  /// Dots closer than this, in pitches derived from their radius, join into one area.
  double join_pitches = 3.6;
  double max_size_ratio = 1.5;  ///< dots whose radii differ by more do not join
};

/// Dilation (paper, section 4.1, Fig. 2c): groups dots into marker areas. Two dots dilated by a disc touch
/// when their centres are nearer than its diameter, so no image is dilated. The diameter follows from the
/// dots' radius, a quarter of the pitch: dots of one marker are at most 3 pitches from the next (O and X of
/// ID 0), those of markers whose middles are 30 cm apart rarely as near. Reuses its buffers from frame to
/// frame.
class MarkerAreaFinder {
 public:
  explicit MarkerAreaFinder(const MarkerAreaOptions& options = {}) : options_(options) {}

  /// Returns the number of areas, ordered by their first dot. Discards the previous result.
  std::size_t find(std::span<const Dot> dots);

  /// The dots of one area, in input order.
  [[nodiscard]] std::span<const Dot> dots_of(std::size_t area) const;

 private:
  void join(std::span<const Dot> dots);

  MarkerAreaOptions options_;
  std::vector<std::size_t> order_;  ///< dot indices, from top to bottom
  DisjointSets sets_;
  std::vector<std::size_t> numbers_;
  std::vector<std::size_t> ends_;  ///< end of each area in `dots_`
  std::vector<Dot> dots_;          ///< sorted by area
};

}  // namespace lodestar
