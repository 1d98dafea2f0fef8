#include "maps/convex_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "maps/touching.hpp"

namespace lodestar {
namespace {

std::array<Vec2, 4> square_of(Cell cell) {
  const Vec2 low(cell.column, cell.row);
  return {low, low + Vec2(1.0, 0.0), low + Vec2(1.0, 1.0), low + Vec2(0.0, 1.0)};
}

bool is_convex(const Polygon& polygon) {
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 in = polygon[(i + 1) % count] - polygon[i];
    const Vec2 out = polygon[(i + 2) % count] - polygon[(i + 1) % count];
    if (cross(in, out) < 0.0) return false;
  }
  return true;
}

bool is_inside(const std::array<Vec2, 3>& triangle, const Vec2& point) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2& corner = triangle.at(i);
    if (cross(triangle.at((i + 1) % 3) - corner, point - corner) < 0.0) return false;
  }
  return true;
}

/// A left turn with no other corner in its triangle.
bool is_ear(const Polygon& polygon, std::size_t i) {
  const std::size_t count = polygon.size();
  const std::array<Vec2, 3> ear{polygon[(i + count - 1) % count], polygon[i], polygon[(i + 1) % count]};
  if (cross(ear[1] - ear[0], ear[2] - ear[1]) <= 0.0) return false;
  return std::ranges::none_of(polygon, [&](const Vec2& point) {
    return std::ranges::find(ear, point) == ear.end() && is_inside(ear, point);
  });
}

/// Do two segments have a point in common? (Signs of areas; ends on the other segment count.)
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    const double area = cross(q - p, r - p);
    return area > 0.0 ? 1 : area < 0.0 ? -1 : 0;
  };
  const auto within = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return r.x() >= std::min(p.x(), q.x()) && r.x() <= std::max(p.x(), q.x()) &&
           r.y() >= std::min(p.y(), q.y()) && r.y() <= std::max(p.y(), q.y());
  };
  const int c_side = side(a, b, c);
  const int d_side = side(a, b, d);
  const int a_side = side(c, d, a);
  const int b_side = side(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && within(a, b, c)) || (d_side == 0 && within(a, b, d)) ||
         (a_side == 0 && within(c, d, a)) || (b_side == 0 && within(c, d, b));
}

/// Angles from 0 to `turn_rad` at which a point turned about the origin is on the line normal . p = distance.
void add_crossings(const Vec2& point, const Vec2& normal, double distance, double turn_rad,
                   std::vector<double>& angles_rad) {
  const double radius = point.norm() * normal.norm();
  if (!(std::abs(distance) <= radius) || radius == 0.0) return;
  const double between_rad = std::acos(distance / radius);
  const double start_rad = heading_of(point);
  const double normal_rad = heading_of(normal);
  for (const double at_rad : {normal_rad + between_rad, normal_rad - between_rad}) {
    const double angle_rad = wrap_angle(at_rad - start_rad);
    for (const double whole : {-2.0 * std::numbers::pi, 0.0, 2.0 * std::numbers::pi}) {
      const double candidate_rad = angle_rad + whole;
      if (candidate_rad * turn_rad > 0.0 && std::abs(candidate_rad) < std::abs(turn_rad))
        angles_rad.push_back(candidate_rad);
    }
  }
}

/// All angles at which the overlap may change, and both ends, in the order of the turn.
std::vector<double> angles_of_change(const Polygon& about_origin, const std::array<Vec2, 4>& square,
                                     double turn_rad) {
  std::vector<double> angles_rad{0.0, turn_rad};
  const std::size_t count = about_origin.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& corner = about_origin[i];
    for (const std::size_t side : {0U, 2U}) {
      add_crossings(corner, Vec2(1.0, 0.0), square.at(side).x(), turn_rad, angles_rad);
      add_crossings(corner, Vec2(0.0, 1.0), square.at(side).y(), turn_rad, angles_rad);
    }
    // In the polygon's frame the square's corners turn the other way.
    const Vec2 edge = about_origin[(i + 1) % count] - corner;
    const Vec2 normal(edge.y(), -edge.x());
    for (const Vec2& point : square) {
      std::vector<double> seen_rad;
      add_crossings(point, normal, normal.dot(corner), -turn_rad, seen_rad);
      for (const double angle_rad : seen_rad) angles_rad.push_back(-angle_rad);
    }
  }
  std::ranges::sort(angles_rad, [](double a, double b) { return std::abs(a) < std::abs(b); });
  return angles_rad;
}

bool is_beyond_an_edge(const Polygon& polygon, const std::array<Vec2, 4>& square) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec2 outwards = Vec2(edge.y(), -edge.x()).normalized();
    const auto beyond = [&](const Vec2& corner) { return outwards.dot(corner - polygon[i]) >= -touching; };
    if (std::ranges::all_of(square, beyond)) return true;
  }
  return false;
}

}  // namespace

Polygon hull_of(std::vector<Vec2> points) {
  std::ranges::sort(
      points, [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  Polygon hull;
  const auto add = [&hull](const Vec2& point, std::size_t fixed) {
    while (hull.size() > fixed + 1 &&
           cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Vec2& point : points) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

std::vector<Polygon> convex_pieces(const Polygon& polygon) {
  std::vector<Polygon> pieces;
  Polygon rest = polygon;
  while (!is_convex(rest)) {
    std::size_t ear = 0;
    while (ear < rest.size() && !is_ear(rest, ear)) ++ear;
    if (ear == rest.size()) break;  // only rounding can hide the ears of a simple polygon
    const std::size_t count = rest.size();
    pieces.push_back({rest[(ear + count - 1) % count], rest[ear], rest[(ear + 1) % count]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  pieces.push_back(is_convex(rest) ? rest : hull_of(rest));
  return pieces;
}

bool is_simple(const Polygon& polygon) {
  const std::size_t count = polygon.size();
  double doubled_area = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % count];
    const Vec2& c = polygon[(i + 2) % count];
    doubled_area += cross(a, b);
    if (a == b || (cross(b - a, c - b) == 0.0 && (b - a).dot(c - b) < 0.0)) return false;
    for (std::size_t j = i + 2; j < count; ++j) {
      const bool neighbours = i == 0 && j + 1 == count;
      if (!neighbours && meet(a, b, polygon[j], polygon[(j + 1) % count])) return false;
    }
  }
  return count >= 3 && doubled_area > 0.0;
}

/// Separating axes: the square's sides, then the polygon's edges.
bool overlaps(const Polygon& convex, Cell cell) {
  Vec2 low = convex.front();
  Vec2 high = low;
  for (const Vec2& corner : convex) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  if (low.x() >= cell.column + 1 - touching || high.x() <= cell.column + touching) return false;
  if (low.y() >= cell.row + 1 - touching || high.y() <= cell.row + touching) return false;
  return !is_beyond_an_edge(convex, square_of(cell));
}

bool overlaps_turning(const Polygon& convex, const Vec2& about, double turn_rad, Cell cell) {
  std::array<Vec2, 4> square = square_of(cell);
  for (Vec2& corner : square) corner -= about;
  Polygon about_origin = convex;
  double farthest = 0.0;
  for (Vec2& corner : about_origin) {
    corner -= about;
    farthest = std::max(farthest, corner.norm());
  }
  const Vec2 nearest = Vec2::Zero().cwiseMax(square[0]).cwiseMin(square[2]);
  if (nearest.norm() >= farthest - touching) return false;

  const std::vector<double> angles_rad = angles_of_change(about_origin, square, turn_rad);
  Polygon turned(convex.size());
  const auto overlaps_at = [&](double angle_rad) {
    const Pose2 turn{about, angle_rad};
    std::ranges::transform(about_origin, turned.begin(), [&](const Vec2& corner) { return turn * corner; });
    return overlaps(turned, cell);
  };
  if (overlaps_at(0.0) || overlaps_at(turn_rad)) return true;
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    if (overlaps_at(0.5 * (angles_rad[i - 1] + angles_rad[i]))) return true;
  }
  return false;
}

}  // namespace lodestar
