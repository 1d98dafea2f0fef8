#include "maps/ray_casting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

bool is_occupied(std::int8_t value) {
  return value >= 50;
}

/// A ray along one axis of the grid. Lengths are along the ray, in cells.
struct RayAxis {
  double from = 0.0;
  double slope = 0.0;  ///< of this coordinate, per length
  int count = 0;       ///< cells of the grid
  double entry = 0.0;  ///< into the grid's slab, and out of it
  double exit = never;
  int cell = 0;
  int step = 0;
  double next_border = never;  ///< to the border of the present cell
  double between_borders = never;

  RayAxis(double begin, double rise, int cells) : from(begin), slope(rise), count(cells) {
    if (slope == 0.0) {
      if (from < 0.0 || from >= count) exit = -1.0;  // passes beside the grid
      return;
    }
    const double to_low = -from / slope;
    const double to_high = (count - from) / slope;
    entry = std::max(0.0, std::min(to_low, to_high));
    exit = std::max(to_low, to_high);
  }

  void begin_at(double length) {
    cell = std::clamp(static_cast<int>(std::floor(from + length * slope)), 0, count - 1);
    if (slope == 0.0) return;
    step = slope > 0.0 ? 1 : -1;
    between_borders = 1.0 / std::abs(slope);
    next_border = std::max(length, (cell + (step > 0 ? 1.0 : 0.0) - from) / slope);
  }
};

}  // namespace

std::optional<RayHit> cast_ray(const OccupancyMap& map, const Vec2& from_in_map, double heading_in_map_rad,
                               double max_range_m) {
  if (!from_in_map.allFinite() || !std::isfinite(heading_in_map_rad) || std::isnan(max_range_m) ||
      map.cells.empty())
    return std::nullopt;
  const Vec2 from = inverse(map.map_from_grid) * from_in_map / map.resolution_m;
  const double heading_rad = heading_in_map_rad - map.map_from_grid.yaw_rad;
  RayAxis x(from.x(), std::cos(heading_rad), map.columns);
  RayAxis y(from.y(), std::sin(heading_rad), map.rows);
  double length = std::max(x.entry, y.entry);
  const double end = std::min({x.exit, y.exit, max_range_m / map.resolution_m});
  if (length > end) return std::nullopt;
  bool crossed_x = x.entry >= y.entry;
  x.begin_at(length);
  y.begin_at(length);
  while (true) {
    if (is_occupied(map.at({x.cell, y.cell}))) {
      const double incidence_cos = std::abs(crossed_x ? x.slope : y.slope);
      return RayHit{length * map.resolution_m, length > 0.0 ? incidence_cos : 1.0};
    }
    crossed_x = x.next_border < y.next_border;
    RayAxis& crossed = crossed_x ? x : y;
    length = crossed.next_border;
    crossed.cell += crossed.step;
    crossed.next_border += crossed.between_borders;
    if (length > end || crossed.cell < 0 || crossed.cell >= crossed.count) return std::nullopt;
  }
}

std::optional<double> range_to_obstacle_m(const OccupancyMap& map, const Vec2& from_in_map,
                                          double heading_in_map_rad, double max_range_m) {
  const std::optional<RayHit> hit = cast_ray(map, from_in_map, heading_in_map_rad, max_range_m);
  return hit ? std::optional(hit->range_m) : std::nullopt;
}

std::optional<RayHit> cast_ray_at_disc(const Vec2& from, const Vec2& direction, const Vec2& center,
                                       double radius_m) {
  const Vec2 way = center - from;
  const double along_m = way.dot(direction);
  const double aside_m = cross(direction, way);
  const double inside_m2 = square(radius_m) - square(aside_m);
  if (!(inside_m2 > 0.0)) return std::nullopt;
  if (way.squaredNorm() <= square(radius_m)) return RayHit{0.0, 1.0};
  if (along_m < 0.0) return std::nullopt;
  const double half_chord_m = std::sqrt(inside_m2);
  return RayHit{along_m - half_chord_m, half_chord_m / radius_m};
}

bool is_in_sight(const OccupancyMap& map, const Vec2& from_in_map, const Vec2& to_in_map) {
  const Vec2 way = to_in_map - from_in_map;
  return !cast_ray(map, from_in_map, heading_of(way), way.norm());
}

}  // namespace lodestar
