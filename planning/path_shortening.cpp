#include "planning/path_shortening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {
namespace {

bool goes_straight(const Vec2& before, const Vec2& at, const Vec2& after) {
  const Vec2 a = at - before;
  const Vec2 b = after - at;
  return std::abs(cross(a, b)) < 1e-9 && a.dot(b) > 0.0;
}

}  // namespace

std::vector<Vec2> leg_ends(const std::vector<Vec2>& points) {
  constexpr double spacing_cells = 6.0;
  std::vector<Vec2> chosen{points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const bool turn = !goes_straight(points[i - 1], points[i], points[i + 1]);
    if (turn || (points[i] - chosen.back()).norm() >= spacing_cells) chosen.push_back(points[i]);
  }
  chosen.push_back(points.back());
  return chosen;
}

std::vector<Vec2> pulled_tight(const std::vector<Vec2>& points, const CollisionChecker& space) {
  std::vector<Vec2> tight{points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (!space.along(tight.back(), points[i + 1])) tight.push_back(points[i]);
  }
  tight.push_back(points.back());
  return tight;
}

std::vector<Vec2> shortened(const std::vector<Vec2>& points, const CollisionChecker& space,
                            const PathCost& cost, double turn_cost_m) {
  if (points.size() < 3) return points;
  const std::vector<Vec2> at = leg_ends(points);
  std::vector<double> best(at.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> came_from(at.size(), 0);
  best[0] = 0.0;
  for (std::size_t to = 1; to < at.size(); ++to) {
    for (std::size_t from = 0; from < to; ++from) {
      const double so_far = best[from] + (from == 0 ? 0.0 : turn_cost_m);
      if (so_far + cost.at_least((at[to] - at[from]).norm()) >= best[to])
        continue;  // pruned by the lower bound
      const double total = so_far + cost.leg(at[from], at[to]);
      // A leg from the point before is part of the given path and needs no collision check.
      if (total >= best[to] || (from + 1 < to && !space.along(at[from], at[to]))) continue;
      best[to] = total;
      came_from[to] = from;
    }
  }
  std::vector<Vec2> legs{at.back()};
  for (std::size_t i = at.size() - 1; i != 0; i = came_from[i]) legs.push_back(at[came_from[i]]);
  std::ranges::reverse(legs);
  return legs;
}

}  // namespace lodestar
