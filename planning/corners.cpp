#include "planning/corners.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestar {
namespace {

/// Direction away from the obstacle at the lower left corner of this cell. Nothing unless that is an outer
/// corner: one of the four cells around it is an obstacle, three are free.
std::optional<Vec2> outwards(const OccupancyMap& map, int column, int row) {
  int obstacles = 0;
  Vec2 away = Vec2::Zero();
  for (const auto& [dx, dy] : {std::pair(-1, -1), std::pair(0, -1), std::pair(-1, 0), std::pair(0, 0)}) {
    if (is_drivable(map.at({column + dx, row + dy}))) continue;
    ++obstacles;
    away = Vec2(dx == 0 ? -1.0 : 1.0, dy == 0 ? -1.0 : 1.0);
  }
  if (obstacles != 1) return std::nullopt;
  return away;
}

/// A quarter circle about a corner; angles are from the grid's x axis, mirrored into the first quadrant.
struct Arc {
  Vec2 corner;
  Vec2 away;  ///< signs of the quadrant
  double radius_cells = 0.0;

  [[nodiscard]] Vec2 at(double angle_rad, double reach_cells) const {
    return corner + reach_cells * Vec2(away.x() * std::cos(angle_rad), away.y() * std::sin(angle_rad));
  }
};

/// Adds the `count` vertices of the polygon tangent to the arc from one angle to another.
void add_vertices(const CollisionChecker& space, const Arc& arc, double from_rad, double to_rad, int count,
                  bool tight, std::vector<TurnPoint>& points) {
  const double half_step = 0.5 * (to_rad - from_rad) / count;
  for (int i = 0; i < count; ++i) {
    const Vec2 position = arc.at(from_rad + half_step * (2 * i + 1), arc.radius_cells / std::cos(half_step));
    if (space.along(position, position)) points.push_back({position, arc.corner, tight});
  }
}

void add_open_part(const CollisionChecker& space, const Arc& arc, double from_rad, double to_rad,
                   std::vector<TurnPoint>& points) {
  constexpr double widest_rad = radians(30.0);
  const int count = std::max(1, static_cast<int>(std::ceil((to_rad - from_rad) / widest_rad - 1e-9)));
  add_vertices(space, arc, from_rad, to_rad, count, true, points);
  if (count > 1) add_vertices(space, arc, from_rad, to_rad, 1, false, points);
}

/// Finds the clear parts of the quarter circle in steps of 5 degrees.
void add_arc(const CollisionChecker& space, const Arc& arc, std::vector<TurnPoint>& points) {
  constexpr int steps = 18;
  constexpr double step_rad = radians(90.0) / steps;
  std::optional<int> open_since;
  for (int i = 0; i <= steps + 1; ++i) {
    const Vec2 place = arc.at(i * step_rad, arc.radius_cells);
    const bool open = i <= steps && space.along(place, place);
    if (open && !open_since) open_since = i;
    if (open || !open_since) continue;
    add_open_part(space, arc, *open_since * step_rad, (i - 1) * step_rad, points);
    open_since.reset();
  }
}

}  // namespace

std::vector<TurnPoint> turn_points(const CollisionChecker& space, double reach_cells) {
  const OccupancyMap& map = space.map();
  std::vector<TurnPoint> points;
  for (int row = 1; row < map.rows; ++row) {
    for (int column = 1; column < map.columns; ++column) {
      const std::optional<Vec2> away = outwards(map, column, row);
      if (!away) continue;
      constexpr double apart = 1e-6;  // cells, so that rounding makes no tangent overlap
      const Arc arc{Vec2(column, row), *away, reach_cells + apart};
      add_arc(space, arc, points);
    }
  }
  return points;
}

}  // namespace lodestar
