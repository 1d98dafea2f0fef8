#include "app/placement/lines_of_sight.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

LinesOfSight::LinesOfSight(const CoveredFloor& floor)
    : floor_(floor), grid_from_map_(inverse(floor.map.map_from_grid)) {}

Vec2 LinesOfSight::in_cells(const Vec2& on_map) const {
  return (grid_from_map_ * on_map) / floor_.map.resolution_m;
}

bool LinesOfSight::is_clear(Cell low, Cell high) const {
  const OccupancyMap& map = floor_.map;
  if (!map.contains(low) || !map.contains(high)) return false;
  for (int row = low.row; row <= high.row; ++row) {
    for (std::size_t i = map.index({low.column, row}); i <= map.index({high.column, row}); ++i)
      if (floor_.heights ? floor_.heights->cells[i] != 0 : map.cells[i] >= 50) return false;
  }
  return true;
}

bool LinesOfSight::is_free(const Vec2& at, const Vec2& marker, double marker_z_m) const {
  return floor_.heights ? is_free_in_height(*floor_.heights, at, marker, marker_z_m)
                        : is_free_on_map(at, marker);
}

bool LinesOfSight::is_free_on_map(const Vec2& at, const Vec2& marker) const {
  const auto steps = static_cast<int>(std::ceil((at - marker).norm()));
  bool is_over = true;
  for (int i = 0; i < steps; ++i) {
    const Cell cell = cell_at(marker + (at - marker) * (static_cast<double>(i) / steps));
    if (!floor_.map.contains(cell)) return false;
    const bool is_occupied = floor_.map.at(cell) >= 50;
    if (is_occupied && !is_over) return false;
    is_over = is_over && is_occupied;
  }
  return true;
}

bool LinesOfSight::is_free_in_height(const HeightBands& heights, const Vec2& at, const Vec2& marker,
                                     double marker_z_m) const {
  const OccupancyMap& map = floor_.map;
  const double camera_z_m = floor_.view.camera_height_m;
  const double length_m = std::hypot(map.resolution_m * (at - marker).norm(), marker_z_m - camera_z_m);
  const auto steps = static_cast<int>(std::ceil(2.0 * length_m / std::min(map.resolution_m, heights.step_m)));
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    if (std::min(t, 1.0 - t) * length_m <= heights.touch_m) continue;
    const Cell cell = cell_at(at + t * (marker - at));
    if (!map.contains(cell)) continue;
    const double z_m = camera_z_m + t * (marker_z_m - camera_z_m);
    const auto band = static_cast<int>(std::floor((z_m - heights.low_m) / heights.step_m));
    if (band < 0 || band >= HeightBands::count) continue;
    if ((heights.cells[map.index(cell)] >> static_cast<unsigned>(band) & 1U) != 0) return false;
  }
  return true;
}

}  // namespace lodestar
