#include "planning/corners.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

namespace lodestar {
namespace {

/// Calls for the lower left corner of each cell that is an outer corner of the obstacles: one of the four
/// cells around it is an obstacle, three are free. With the direction away from that one. Row by row.
template <typename Work>
void for_each_outer_corner(const CollisionChecker& space, const Work& work) {
  for (int row = 1; row < space.rows(); ++row) {
    const std::span<const std::uint64_t> below = space.field().obstacles(row - 1);
    const std::span<const std::uint64_t> above = space.field().obstacles(row);
    for (std::size_t i = 0; i < above.size(); ++i) {
      const std::uint64_t a = below[i];
      const std::uint64_t b = above[i];
      const std::uint64_t a_left = a << 1U | (i > 0 ? below[i - 1] >> 63U : 0U);
      const std::uint64_t b_left = b << 1U | (i > 0 ? above[i - 1] >> 63U : 0U);
      const std::uint64_t two = (a & b) | (a_left & b_left) | ((a | b) & (a_left | b_left));
      std::uint64_t one = (a | b | a_left | b_left) & ~two;
      if (i == 0) one &= ~std::uint64_t{1};  // the first column has no cell to its left
      for (; one != 0; one &= one - 1) {
        const int bit = std::countr_zero(one);
        const int column = static_cast<int>(i) * 64 + bit;
        if (column >= space.columns()) break;
        const auto is = [&](std::uint64_t bits) { return ((bits >> static_cast<unsigned>(bit)) & 1U) != 0; };
        work(Vec2(column, row), Vec2(is(a_left | b_left) ? 1.0 : -1.0, is(a | a_left) ? 1.0 : -1.0));
      }
    }
  }
}

/// A quarter circle about a corner; angles are from the grid's x axis, mirrored into the first quadrant.
struct Arc {
  Vec2 corner;
  Vec2 away;  ///< signs of the quadrant
  double radius_cells = 0.0;

  [[nodiscard]] Vec2 at(double angle_rad, double reach_cells) const {
    return towards({std::cos(angle_rad), std::sin(angle_rad)}, reach_cells);
  }
  [[nodiscard]] Vec2 towards(const Vec2& direction, double reach_cells) const {
    return corner + reach_cells * away.cwiseProduct(direction);
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

constexpr int steps = 18;
constexpr double step_rad = radians(90.0) / steps;

/// From the x axis to the y axis.
std::array<Vec2, steps + 1> directions_of_steps() {
  std::array<Vec2, steps + 1> directions;
  for (int i = 0; i <= steps; ++i)
    directions[static_cast<std::size_t>(i)] = Vec2(std::cos(i * step_rad), std::sin(i * step_rad));
  return directions;
}

/// Finds the clear parts of the quarter circle in steps of 5 degrees.
void add_arc(const CollisionChecker& space, const Arc& arc, std::vector<TurnPoint>& points) {
  static const std::array<Vec2, steps + 1> directions = directions_of_steps();
  std::optional<int> open_since;
  for (int i = 0; i <= steps + 1; ++i) {
    const auto is_clear = [&](const Vec2& place) { return space.along(place, place); };
    const bool open =
        i <= steps && is_clear(arc.towards(directions[static_cast<std::size_t>(i)], arc.radius_cells));
    if (open && !open_since) open_since = i;
    if (open || !open_since) continue;
    add_open_part(space, arc, *open_since * step_rad, (i - 1) * step_rad, points);
    open_since.reset();
  }
}

}  // namespace

std::vector<TurnPoint> turn_points(const CollisionChecker& space, double reach_cells) {
  std::vector<TurnPoint> points;
  for_each_outer_corner(space, [&](const Vec2& corner, const Vec2& away) {
    constexpr double apart = 1e-6;  // cells, so that rounding makes no tangent overlap
    add_arc(space, {corner, away, reach_cells + apart}, points);
  });
  return points;
}

}  // namespace lodestar
