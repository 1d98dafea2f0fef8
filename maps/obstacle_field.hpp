#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// An occupancy map with what all collision checks on it share, whatever the radius: its obstacles as bits,
/// and the exact distance from each cell to the nearest obstacle (Felzenszwalb and Huttenlocher 2012). 3
/// bytes a cell and a quarter. Everything outside the map is obstacle.
class ObstacleField {
 public:
  explicit ObstacleField(OccupancyMap map);

  [[nodiscard]] const OccupancyMap& map() const { return map_; }

  /// Squared distances are exact below this; it stands for all greater ones.
  static constexpr std::uint16_t far = 0xffff;

  /// From a cell's centre to that of the nearest one that is not drivable, in cells, squared.
  [[nodiscard]] std::uint16_t squared_cells(std::size_t index) const { return squared_[index]; }
  [[nodiscard]] double distance_cells(std::size_t index) const {
    return static_cast<double>(std::sqrt(static_cast<float>(squared_[index])));
  }

  /// A row's cells that are not drivable, 64 to a word, the first one in the lowest bit.
  [[nodiscard]] std::span<const std::uint64_t> obstacles(int row) const {
    return {&obstacles_[static_cast<std::size_t>(row) * words_a_row_], words_a_row_};
  }
  /// A column's, likewise.
  [[nodiscard]] std::span<const std::uint64_t> obstacles_of_column(int column) const {
    return {&by_column_[static_cast<std::size_t>(column) * words_a_column_], words_a_column_};
  }

 private:
  void mark_obstacles();
  void mark_by_column();
  void measure_columns();
  void measure_rows();

  OccupancyMap map_;
  std::size_t words_a_row_ = 0;
  std::vector<std::uint64_t> obstacles_;
  std::size_t words_a_column_ = 0;
  std::vector<std::uint64_t> by_column_;
  std::vector<std::uint16_t> squared_;
};

}  // namespace lodestar
