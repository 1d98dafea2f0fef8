#include "drivers/simulation/disc_contact.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Overlaps below this count as touching; allows only for the rounding of coordinates.
constexpr double touch_m = 1e-9;

/// Distance of a coordinate from the interval [cell, cell + 1].
double distance_to_cell(double coordinate, int cell) {
  return std::max({cell - coordinate, coordinate - (cell + 1.0), 0.0});
}

bool is_inside_grid(const OccupancyMap& map, const Vec2& centre, double radius) {
  return centre.x() - radius >= 0.0 && centre.y() - radius >= 0.0 && centre.x() + radius <= map.columns &&
         centre.y() + radius <= map.rows;
}

}  // namespace

bool disc_overlaps_obstacle(const OccupancyMap& map, const Vec2& centre_in_map, double radius_m) {
  // From here on in the grid frame, in units of cells.
  const Vec2 centre = inverse(map.map_from_grid) * centre_in_map / map.resolution_m;
  const double radius = std::max(0.0, radius_m - touch_m) / map.resolution_m;
  if (!is_inside_grid(map, centre, radius)) return true;  // NaN is never inside

  const int last_row = std::min(static_cast<int>(centre.y() + radius), map.rows - 1);
  const int last_column = std::min(static_cast<int>(centre.x() + radius), map.columns - 1);
  for (int row = static_cast<int>(centre.y() - radius); row <= last_row; ++row) {
    const double away_y = distance_to_cell(centre.y(), row);
    for (int column = static_cast<int>(centre.x() - radius); column <= last_column; ++column) {
      if (is_drivable(map.at({column, row}))) continue;
      const double away_x = distance_to_cell(centre.x(), column);
      if (away_x * away_x + away_y * away_y < radius * radius) return true;
    }
  }
  return false;
}

}  // namespace lodestar
