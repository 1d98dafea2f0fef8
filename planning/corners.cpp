#include "planning/corners.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace lodestar {
namespace {

/// Away from the obstacle's corner at the lower left of this cell, or nothing when no outer corner is there:
/// one of the four cells around it is an obstacle, three are free.
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

struct Vertex {
  double angle_rad = 0.0;
  bool tight = true;
};
constexpr double half_step_rad = radians(15.0);
constexpr std::array<Vertex, 4> vertices{{{radians(45.0), false},
                                          {half_step_rad, true},
                                          {3.0 * half_step_rad, true},
                                          {5.0 * half_step_rad, true}}};

}  // namespace

std::vector<TurnPoint> turn_points(const ClearSpace& space, double reach_cells) {
  const OccupancyMap& map = space.map();
  std::vector<TurnPoint> points;
  for (int row = 1; row < map.rows; ++row) {
    for (int column = 1; column < map.columns; ++column) {
      const std::optional<Vec2> away = outwards(map, column, row);
      if (!away) continue;
      const Vec2 corner(column, row);
      for (const Vertex& vertex : vertices) {
        const double reach = reach_cells / std::cos(vertex.tight ? half_step_rad : radians(45.0));
        const Vec2 position = corner + reach * Vec2(away->x() * std::cos(vertex.angle_rad),
                                                    away->y() * std::sin(vertex.angle_rad));
        if (space.along(position, position)) points.push_back({position, corner, vertex.tight});
      }
    }
  }
  return points;
}

}  // namespace lodestar
