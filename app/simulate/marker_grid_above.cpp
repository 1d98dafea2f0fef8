#include "app/simulate/marker_grid_above.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "maps/marker_code.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr double spacing_m = 1.5;
constexpr double ceiling_m = 2.6;
/// Where the largest code has fewer words than the grid has places.
constexpr double wider = 1.1;

/// Is any cell within this many cells drivable?
bool is_near_floor(const OccupancyMap& map, const Vec2& point_in_grid, int reach) {
  const Cell at = cell_at(point_in_grid);
  for (int row = std::max(0, at.row - reach); row <= std::min(map.rows - 1, at.row + reach); ++row)
    for (int column = std::max(0, at.column - reach); column <= std::min(map.columns - 1, at.column + reach);
         ++column)
      if (is_drivable(map.at({column, row}))) return true;
  return false;
}

/// In the map frame, evenly over its whole rectangle.
std::vector<Vec2> places_above(const OccupancyMap& map, double wanted_spacing_m) {
  const double width_m = map.columns * map.resolution_m;
  const double height_m = map.rows * map.resolution_m;
  const int columns = std::max(1, static_cast<int>(std::lround(width_m / wanted_spacing_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(height_m / wanted_spacing_m)));
  const int reach = static_cast<int>(std::ceil(0.5 * wanted_spacing_m / map.resolution_m));
  std::vector<Vec2> places_m;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 place_m((column + 0.5) * width_m / columns, (row + 0.5) * height_m / rows);
      if (is_near_floor(map, place_m / map.resolution_m, reach))
        places_m.emplace_back(map.map_from_grid * place_m);
    }
  }
  return places_m;
}

}  // namespace

MarkerRegistry marker_grid_above(const OccupancyMap& map) {
  MarkerRegistry registry;
  std::vector<Vec2> places_m = places_above(map, spacing_m);
  const std::vector<int> ids = choose_marker_ids(static_cast<int>(places_m.size()), {});
  for (double apart_m = spacing_m * wider; places_m.size() > ids.size(); apart_m *= wider)
    places_m = places_above(map, apart_m);
  Random random(1);
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    registry.markers.push_back({.id = ids[i],
                                .position_m = {places_m[i].x(), places_m[i].y(), ceiling_m},
                                .yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi)});
  }
  return registry;
}

}  // namespace lodestar
