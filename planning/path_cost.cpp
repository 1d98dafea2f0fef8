#include "planning/path_cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {

EndHeadings headings_of_part(std::span<const Vec2> points, std::size_t from, std::size_t to,
                             const EndHeadings& of_path) {
  EndHeadings headings = of_path;
  if (from > 0) headings.start_rad = heading_between(points[from - 1], points[from]);
  if (to + 1 < points.size()) headings.goal_rad = heading_between(points[to], points[to + 1]);
  return headings;
}

double PathCost::leg(const Vec2& from, const Vec2& to) const {
  const double least = at_least((to - from).norm());
  return counts_cells() ? least * mean_cell_cost(from, to) : least;
}

/// Sampled every half cell. Infinite for a leg out of the map.
double PathCost::mean_cell_cost(const Vec2& from, const Vec2& to) const {
  if (!is_on_map(from) || !is_on_map(to)) return std::numeric_limits<double>::infinity();
  const int samples = std::max(1, static_cast<int>(std::ceil(2.0 * (to - from).norm())));
  const Vec2 step = (to - from) / samples;
  double sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Vec2 point = from + (i + 0.5) * step;
    sum +=
        static_cast<double>(costs_[map_.index({static_cast<int>(point.x()), static_cast<int>(point.y())})]);
  }
  return sum / samples;
}

bool PathCost::is_on_map(const Vec2& point) const {
  return point.x() >= 0.0 && point.y() >= 0.0 && point.x() < map_.columns && point.y() < map_.rows;
}

double PathCost::path(std::span<const Vec2> points, const EndHeadings& headings) const {
  double cost = 0.0;
  std::optional<double> heading = headings.start_rad;
  for (std::size_t i = 1; i < points.size(); ++i) {
    cost += leg(points[i - 1], points[i]);
    if (!counts_turns() || points[i] == points[i - 1]) continue;
    const double next = heading_between(points[i - 1], points[i]);
    if (heading) cost += turn(*heading, next);
    heading = next;
  }
  if (heading && headings.goal_rad) cost += turn(*heading, *headings.goal_rad);
  return cost;
}

}  // namespace lodestar
