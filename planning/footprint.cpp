#include "planning/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr double touching = 1e-9;  ///< cells; rounding must not turn touching into overlapping

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise (Andrew 1979).
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  std::ranges::sort(
      points, [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Vec2> hull;
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

/// Is the square of a cell wholly beyond one edge of the polygon grown by a margin? (Separating axes; those
/// of the square are the polygon's bounds, which the caller keeps to.)
bool is_beyond_an_edge(const std::vector<Vec2>& polygon, Cell cell, double margin) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec2 outwards = Vec2(edge.y(), -edge.x()).normalized();
    const Vec2 nearest(cell.column + (outwards.x() < 0.0 ? 1.0 : 0.0),
                       cell.row + (outwards.y() < 0.0 ? 1.0 : 0.0));
    if (outwards.dot(nearest - polygon[i]) >= margin - touching) return true;
  }
  return false;
}

/// A convex polygon in grid coordinates, grown by a margin.
bool is_clear_polygon(const OccupancyMap& map, const std::vector<Vec2>& polygon, double margin) {
  Vec2 low = polygon.front();
  Vec2 high = polygon.front();
  for (const Vec2& point : polygon) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  low = low.array() - margin + touching;
  high = high.array() + margin - touching;
  if (!low.allFinite() || !high.allFinite() || low.minCoeff() < 0.0 || high.x() > map.columns ||
      high.y() > map.rows) {
    return false;
  }
  for (int row = static_cast<int>(low.y()); row <= std::min(static_cast<int>(high.y()), map.rows - 1);
       ++row) {
    for (int column = static_cast<int>(low.x());
         column <= std::min(static_cast<int>(high.x()), map.columns - 1); ++column) {
      if (!is_drivable(map.at({column, row})) && !is_beyond_an_edge(polygon, {column, row}, margin))
        return false;
    }
  }
  return true;
}

std::vector<Vec2> outline_in_grid(const OccupancyMap& map, const std::vector<Vec2>& corners_m,
                                  const Pose2& pose) {
  const Pose2 grid_from_robot = inverse(map.map_from_grid) * pose;
  std::vector<Vec2> outline;
  for (const Vec2& corner : corners_m) outline.emplace_back(grid_from_robot * corner / map.resolution_m);
  return outline;
}

}  // namespace

Footprint::Footprint(std::vector<Vec2> corners_m) : corners_m_(std::move(corners_m)) {
  const std::size_t count = corners_m_.size();
  if (count < 3) throw InputError(fmt::format("footprint: found {} corners, wanted at least 3", count));
  double turned_rad = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 in = corners_m_[(i + 1) % count] - corners_m_[i];
    const Vec2 out = corners_m_[(i + 2) % count] - corners_m_[(i + 1) % count];
    if (!(cross(in, out) > 0.0)) {
      throw InputError(fmt::format(
          "footprint: found no left turn at corner {}, wanted a convex polygon, counter-clockwise",
          (i + 1) % count + 1));
    }
    turned_rad += std::atan2(cross(in, out), in.dot(out));
  }
  constexpr double once_rad = 2.0 * std::numbers::pi + 1e-6;
  if (turned_rad > once_rad) throw InputError("footprint: found corners that go around twice, wanted once");
}

double Footprint::outer_radius_m() const {
  double radius_m = 0.0;
  for (const Vec2& corner : corners_m_) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

bool Footprint::is_clear(const OccupancyMap& map, const Pose2& pose) const {
  return is_clear_polygon(map, outline_in_grid(map, corners_m_, pose), 0.0);
}

bool Footprint::is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const {
  std::vector<Vec2> ends = outline_in_grid(map, corners_m_, from);
  const std::vector<Vec2> there = outline_in_grid(map, corners_m_, {to_m, from.yaw_rad});
  ends.insert(ends.end(), there.begin(), there.end());
  if (!ends.front().allFinite() || !ends.back().allFinite()) return false;
  return is_clear_polygon(map, hull_of(std::move(ends)), 0.0);
}

bool Footprint::is_clear_turning(const OccupancyMap& map, const Pose2& from, double to_rad) const {
  constexpr double step_cells = 0.1;
  const double turn_rad = wrap_angle(to_rad - from.yaw_rad);
  if (!std::isfinite(turn_rad)) return false;
  const double travel_cells = std::abs(turn_rad) * outer_radius_m() / map.resolution_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(travel_cells / step_cells)));
  // Between two steps no point is farther than half a step from where it is in one of them.
  const double margin = travel_cells > 0.0 ? 0.5 * step_cells : 0.0;
  for (int i = 0; i <= steps; ++i) {
    const Pose2 pose{from.position_m, from.yaw_rad + turn_rad * i / steps};
    if (!is_clear_polygon(map, outline_in_grid(map, corners_m_, pose), margin)) return false;
  }
  return true;
}

bool Footprint::is_clear_along(const OccupancyMap& map, const Path& path, double start_heading_rad,
                               std::optional<double> final_heading_rad) const {
  if (path.waypoints_m.empty()) return true;
  Pose2 pose{path.waypoints_m.front(), start_heading_rad};
  for (const Vec2& next : path.waypoints_m) {
    const Vec2 leg = next - pose.position_m;
    if (leg.isZero()) continue;
    const double heading_rad = std::atan2(leg.y(), leg.x());
    if (!is_clear_turning(map, pose, heading_rad)) return false;
    pose.yaw_rad = heading_rad;
    if (!is_clear_driving(map, pose, next)) return false;
    pose.position_m = next;
  }
  return is_clear_turning(map, pose, final_heading_rad.value_or(pose.yaw_rad));
}

}  // namespace lodestar
