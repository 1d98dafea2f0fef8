#include "maps/segment.hpp"

#include <cmath>
#include <limits>

namespace lodestar {

/// Inside when a ray along x crosses an odd number of edges.
double distance_to_outline(std::span<const Vec2> corners, const Vec2& point) {
  double squared = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& a = corners[i];
    const Vec2& b = corners[(i + 1) % corners.size()];
    squared = std::min(squared, (nearest_on_segment(a, b, point) - point).squaredNorm());
    const bool spans = (a.y() > point.y()) != (b.y() > point.y());
    if (spans && point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()))
      is_inside = !is_inside;
  }
  return is_inside ? -std::sqrt(squared) : std::sqrt(squared);
}

}  // namespace lodestar
