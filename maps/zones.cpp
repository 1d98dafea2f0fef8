#include "maps/zones.hpp"

#include <algorithm>
#include <cmath>

#include "maps/segment.hpp"

namespace lodestar {
namespace {

/// In cells of the map, counter-clockwise.
Polygon polygon_in_grid(const OccupancyMap& map, const Polygon& corners_m) {
  const Pose2 grid_from_map = inverse(map.map_from_grid);
  Polygon polygon;
  for (const Vec2& corner_in_map : corners_m)
    polygon.emplace_back(grid_from_map * corner_in_map / map.resolution_m);
  if (!is_simple(polygon)) std::ranges::reverse(polygon);
  return polygon;
}

/// The whole numbers below and above, within 0 and `most`.
int below(double value, int most) {
  return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(most)));
}
int above(double value, int most) {
  return static_cast<int>(std::clamp(std::ceil(value), 0.0, static_cast<double>(most)));
}

void occupy(OccupancyMap& map, const Polygon& convex_in_grid) {
  Vec2 low = convex_in_grid.front();
  Vec2 high = low;
  for (const Vec2& corner : convex_in_grid) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  for (int row = below(low.y(), map.rows); row < above(high.y(), map.rows); ++row) {
    for (int column = below(low.x(), map.columns); column < above(high.x(), map.columns); ++column) {
      const Cell cell{column, row};
      if (overlaps(convex_in_grid, cell)) map.cells[map.index(cell)] = OccupancyMap::occupied;
    }
  }
}

}  // namespace

OccupancyMap with_keep_out(OccupancyMap map, std::span<const KeepOut> keep_out) {
  for (const KeepOut& zone : keep_out)
    for (const Polygon& piece : convex_pieces(polygon_in_grid(map, zone.corners_m))) occupy(map, piece);
  return map;
}

double distance_to(const Polygon& polygon, const Vec2& point) {
  return std::max(0.0, distance_to_outline(polygon, point));
}

}  // namespace lodestar
