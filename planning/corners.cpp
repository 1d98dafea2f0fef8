#include "planning/corners.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "planning/bit_words.hpp"

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

/// The obstacles that may overlap the disc on an arc or on a polygon tangent to it: those near the arc's
/// quadrant, but for those in the opposite one, which the corner keeps away. Legs of furniture have a few,
/// and an arc is looked at in some twenty places.
class ObstaclesOfArc {
 public:
  ObstaclesOfArc(const CollisionChecker& space, const Arc& arc) : space_(space) {
    const double radius = space.radius_cells();
    const Vec2 back = arc.corner - radius * arc.away;
    const Vec2 ahead = arc.corner + (arc.radius_cells + radius) * arc.away;
    const Cell first = cell_at(back.cwiseMin(ahead).cwiseMax(0.0));
    const Cell last = cell_at(back.cwiseMax(ahead).cwiseMin(Vec2(space.columns() - 1, space.rows() - 1)));
    for (int row = first.row; row <= last.row && count_ <= cells_.size(); ++row) {
      const std::span<const std::uint64_t> obstacles = space.field().obstacles(row);
      for (int i = first.column / 64; i <= last.column / 64; ++i) {
        std::uint64_t bits =
            obstacles[static_cast<std::size_t>(i)] & bits_between(i, first.column, last.column);
        for (; bits != 0 && count_ <= cells_.size(); bits &= bits - 1)
          add({64 * i + std::countr_zero(bits), row}, arc);
      }
    }
  }

  /// Is the disc clear at this place, which is no nearer to the corner than the disc's radius?
  [[nodiscard]] bool leave_clear(const Vec2& place) const {
    if (count_ > cells_.size()) return space_.along(place, place);
    const double radius = space_.radius_cells();
    if (place.minCoeff() < radius || place.x() + radius > space_.columns() ||
        place.y() + radius > space_.rows())
      return false;
    return std::none_of(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(count_),
                        [&](const Vec2& cell) {
                          const Vec2 nearest = place.cwiseMax(cell).cwiseMin(cell + Vec2::Ones());
                          return (place - nearest).squaredNorm() < radius * radius;
                        });
  }

 private:
  void add(Cell cell, const Arc& arc) {
    const Vec2 from_corner = arc.away.cwiseProduct(center_of(cell) - arc.corner);
    if (from_corner.maxCoeff() < 0.0) return;
    if (count_ < cells_.size()) cells_[count_] = Vec2(cell.column, cell.row);
    ++count_;
  }

  const CollisionChecker& space_;
  std::array<Vec2, 32> cells_;  ///< lower left corners
  std::size_t count_ = 0;       ///< above their number: too many, the distance field is as quick
};

/// Adds the `count` vertices of the polygon tangent to the arc from one angle to another.
void add_vertices(const ObstaclesOfArc& obstacles, const Arc& arc, double from_rad, double to_rad, int count,
                  bool tight, std::vector<TurnPoint>& points) {
  const double half_step = 0.5 * (to_rad - from_rad) / count;
  for (int i = 0; i < count; ++i) {
    const Vec2 position = arc.at(from_rad + half_step * (2 * i + 1), arc.radius_cells / std::cos(half_step));
    if (obstacles.leave_clear(position)) points.push_back({position, arc.corner, tight});
  }
}

void add_open_part(const ObstaclesOfArc& obstacles, const Arc& arc, double from_rad, double to_rad,
                   std::vector<TurnPoint>& points) {
  constexpr double widest_rad = radians(30.0);
  const int count = std::max(1, static_cast<int>(std::ceil((to_rad - from_rad) / widest_rad - 1e-9)));
  add_vertices(obstacles, arc, from_rad, to_rad, count, true, points);
  if (count > 1) add_vertices(obstacles, arc, from_rad, to_rad, 1, false, points);
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
  const ObstaclesOfArc obstacles(space, arc);
  std::optional<int> open_since;
  for (int i = 0; i <= steps + 1; ++i) {
    const bool open = i <= steps && obstacles.leave_clear(arc.towards(directions[static_cast<std::size_t>(i)],
                                                                      arc.radius_cells));
    if (open && !open_since) open_since = i;
    if (open || !open_since) continue;
    add_open_part(obstacles, arc, *open_since * step_rad, (i - 1) * step_rad, points);
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
