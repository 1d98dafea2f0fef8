#pragma once

#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Exact Euclidean distance transform: for each cell the distance, centre to centre, to the nearest cell that
/// is not drivable (Felzenszwalb and Huttenlocher 2012, two passes of parabola envelopes over squared
/// integers). Everything outside the map counts as not drivable.
class DistanceField {
 public:
  explicit DistanceField(const OccupancyMap& map);

  /// In cells, squared: an exact integer.
  [[nodiscard]] int squared_cells(Cell cell) const { return squared_[index(cell)]; }

  /// Centre to centre in metres; 0 on a cell that is not drivable.
  [[nodiscard]] double distance_m(Cell cell) const;

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

 private:
  [[nodiscard]] std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(cell.column);
  }

  int columns_ = 0;
  int rows_ = 0;
  double resolution_m_ = 0.0;
  std::vector<int> squared_;
};

}  // namespace lodestar
