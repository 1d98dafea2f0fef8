#pragma once

#include <algorithm>
#include <span>

#include "maps/geometry.hpp"

// Distances from straight pieces and from outlines, in the unit of the points.
namespace lodestar {

/// The point between two ends, which may be equal, that is nearest to another.
inline Vec2 nearest_on_segment(const Vec2& from, const Vec2& to, const Vec2& point) {
  const Vec2 way = to - from;
  const double squared_length = way.squaredNorm();
  if (squared_length == 0.0) return from;
  return from + std::clamp((point - from).dot(way) / squared_length, 0.0, 1.0) * way;
}

inline double distance_to_segment(const Vec2& from, const Vec2& to, const Vec2& point) {
  return (nearest_on_segment(from, to, point) - point).norm();
}

/// To a polygon without crossing edges, from a point; negative inside.
double distance_to_outline(std::span<const Vec2> corners, const Vec2& point);

}  // namespace lodestar
