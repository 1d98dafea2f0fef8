#include "maps/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>

#include "maps/input_error.hpp"
#include "maps/segment.hpp"
#include "maps/touching.hpp"

namespace lodestar {
namespace {

/// Bounding box in cells.
struct Bounds {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;

  void add(const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  [[nodiscard]] bool are_on(const OccupancyMap& map) const {
    return low.allFinite() && high.allFinite() && low.minCoeff() >= -touching &&
           high.x() <= map.columns + touching && high.y() <= map.rows + touching;
  }
};

Bounds bounds_of(const std::vector<Polygon>& pieces) {
  Bounds bounds;
  for (const Polygon& piece : pieces) {
    for (const Vec2& corner : piece) bounds.add(corner);
  }
  return bounds;
}

Bounds bounds_of_circle(const Vec2& center, double radius) {
  Bounds bounds;
  bounds.add(center.array() - radius);
  bounds.add(center.array() + radius);
  return bounds;
}

/// Calls visit(cell) for the cells within bounds until one returns false. True when none did.
template <typename Visit>
bool all_within(const Bounds& bounds, const Visit& visit) {
  for (int row = static_cast<int>(std::floor(bounds.low.y() + touching)); row < bounds.high.y() - touching;
       ++row) {
    for (int column = static_cast<int>(std::floor(bounds.low.x() + touching));
         column < bounds.high.x() - touching; ++column) {
      if (!visit(Cell{column, row})) return false;
    }
  }
  return true;
}

std::vector<Polygon> placed(const std::vector<Polygon>& pieces_m, const Pose2& grid_from_robot,
                            double resolution_m) {
  std::vector<Polygon> pieces = pieces_m;
  for (Polygon& piece : pieces) {
    for (Vec2& corner : piece) corner = grid_from_robot * corner / resolution_m;
  }
  return pieces;
}

/// The area that the pieces sweep when shifted.
std::vector<Polygon> swept(std::vector<Polygon> pieces, const Vec2& shift) {
  for (Polygon& piece : pieces) {
    const std::size_t count = piece.size();
    for (std::size_t i = 0; i < count; ++i) piece.emplace_back(piece[i] + shift);
    piece = hull_of(std::move(piece));
  }
  return pieces;
}

bool any_overlaps(const std::vector<Polygon>& pieces, Cell cell) {
  return std::ranges::any_of(pieces, [&](const Polygon& piece) { return overlaps(piece, cell); });
}

bool any_overlaps_turning(const std::vector<Polygon>& pieces, const Vec2& about, double turn_rad, Cell cell) {
  return std::ranges::any_of(
      pieces, [&](const Polygon& piece) { return overlaps_turning(piece, about, turn_rad, cell); });
}

bool are_clear(const OccupancyMap& map, const std::vector<Polygon>& pieces) {
  const Bounds bounds = bounds_of(pieces);
  return bounds.are_on(map) && all_within(bounds, [&](Cell cell) {
           return is_drivable(map.at(cell)) || !any_overlaps(pieces, cell);
         });
}

/// The extremes of a turn are at its ends, or where a corner crosses an axis direction of its circle.
bool turn_stays_on(const OccupancyMap& map, const std::vector<Polygon>& pieces, const Vec2& about,
                   double turn_rad) {
  Bounds bounds;
  for (const Polygon& piece : pieces) {
    for (const Vec2& corner : piece) {
      const Vec2 from = corner - about;
      bounds.add(corner);
      bounds.add(Pose2{about, turn_rad} * from);
      for (const Vec2& side : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
        const double to_side_rad = wrap_angle(heading_of(side) - heading_of(from));
        const bool passes = to_side_rad * turn_rad > 0.0 && std::abs(to_side_rad) < std::abs(turn_rad);
        if (passes) bounds.add(about + from.norm() * side);
      }
    }
  }
  return bounds.are_on(map);
}

Pose2 in_grid(const OccupancyMap& map, const Pose2& pose) {
  return inverse(map.map_from_grid) * pose;
}

}  // namespace

Footprint::Footprint(std::vector<Vec2> corners_m) : corners_m_(std::move(corners_m)) {
  if (corners_m_.size() < 3)
    throw InputError(fmt::format("footprint: found {} corners, wanted at least 3", corners_m_.size()));
  if (!is_simple(corners_m_))
    throw InputError(
        "footprint: found corners that go clockwise, or edges that touch or cross, wanted a simple polygon, "
        "counter-clockwise");
  pieces_m_ = convex_pieces(corners_m_);
}

double Footprint::outer_radius_m() const {
  double radius_m = 0.0;
  for (const Vec2& corner : corners_m_) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

double Footprint::inner_radius_m() const {
  return depth_m(Vec2::Zero());
}

/// Distance from the edges of a point inside; 0 outside.
double Footprint::depth_m(const Vec2& point_m) const {
  return std::max(0.0, -distance_to_outline(corners_m_, point_m));
}

/// Of a lattice of points inside, each the centre of the largest disc there: the largest disc that is not
/// within another one, again and again.
std::vector<InnerDisc> Footprint::inner_discs(double less_m) const {
  const double spacing_m = std::max(0.01, 0.02 * outer_radius_m());
  std::vector<InnerDisc> inside = discs_on_lattice(spacing_m);
  const auto is_deep = [&](const InnerDisc& disc) {
    return disc.radius_m >= less_m || std::ranges::none_of(inside, [&](const InnerDisc& other) {
             return other.radius_m > disc.radius_m + 0.5 * spacing_m &&
                    (other.center_m - disc.center_m).norm() <= 2.0 * less_m;
           });
  };
  std::vector<InnerDisc> deep;
  std::ranges::copy_if(inside, std::back_inserter(deep), is_deep);
  for (InnerDisc& disc : deep) disc.radius_m = std::max(disc.radius_m - less_m, 0.0);
  std::ranges::stable_sort(deep, std::greater(), &InnerDisc::radius_m);
  std::vector<InnerDisc> chosen;
  for (const InnerDisc& disc : deep) {
    const bool is_within = std::ranges::any_of(chosen, [&](const InnerDisc& other) {
      return (other.center_m - disc.center_m).norm() + disc.radius_m <= other.radius_m + spacing_m;
    });
    if (!is_within) chosen.push_back(disc);
  }
  return chosen;
}

/// Beginning half a spacing from the lowest corner, so that a thin footprint has points too.
std::vector<InnerDisc> Footprint::discs_on_lattice(double spacing_m) const {
  Bounds bounds;
  for (const Vec2& corner : corners_m_) bounds.add(corner);
  const Vec2 size = bounds.high - bounds.low;
  const double step_m = std::min(spacing_m, 0.5 * size.minCoeff());
  std::vector<InnerDisc> discs;
  for (double y = bounds.low.y() + 0.5 * step_m; y < bounds.high.y(); y += step_m) {
    for (double x = bounds.low.x() + 0.5 * step_m; x < bounds.high.x(); x += step_m) {
      const double radius_m = depth_m({x, y});
      if (radius_m > 0.0) discs.push_back({{x, y}, radius_m});
    }
  }
  if (discs.empty()) discs.push_back({corners_m_.front(), 0.0});
  return discs;
}

bool Footprint::is_clear(const OccupancyMap& map, const Pose2& pose) const {
  return are_clear(map, placed(pieces_m_, in_grid(map, pose), map.resolution_m));
}

bool Footprint::is_clear_driving(const OccupancyMap& map, const Pose2& from, const Vec2& to_m) const {
  const Pose2 start = in_grid(map, from);
  const Vec2 goal_m = inverse(map.map_from_grid) * to_m;
  if (!start.position_m.allFinite() || !std::isfinite(start.yaw_rad) || !goal_m.allFinite()) return false;
  return are_clear(
      map, swept(placed(pieces_m_, start, map.resolution_m), (goal_m - start.position_m) / map.resolution_m));
}

/// The robot decides which way is the shorter one only when it turns, by a heading that differs a little from
/// the planned one: near half a turn it may be either.
bool Footprint::is_clear_turning(const OccupancyMap& map, const Pose2& from, double to_rad) const {
  constexpr double uncertain_rad = radians(3.0);
  const double turn_rad = wrap_angle(to_rad - from.yaw_rad);
  if (!std::isfinite(turn_rad)) return false;
  if (!is_clear_sweeping(map, from, turn_rad)) return false;
  if (std::abs(turn_rad) < std::numbers::pi - uncertain_rad) return true;
  const double other_way_rad = turn_rad - std::copysign(2.0 * std::numbers::pi, turn_rad);
  const Pose2 halfway{from.position_m, wrap_angle(from.yaw_rad + 0.5 * other_way_rad)};
  return is_clear_sweeping(map, from, 0.5 * other_way_rad) &&
         is_clear_sweeping(map, halfway, 0.5 * other_way_rad);
}

/// By at most half a turn.
bool Footprint::is_clear_sweeping(const OccupancyMap& map, const Pose2& from, double turn_rad) const {
  const Pose2 start = in_grid(map, from);
  const std::vector<Polygon> pieces = placed(pieces_m_, start, map.resolution_m);
  const Vec2 about = start.position_m / map.resolution_m;
  if (!about.allFinite() || !turn_stays_on(map, pieces, about, turn_rad)) return false;
  return all_within(bounds_of_circle(about, outer_radius_m() / map.resolution_m), [&](Cell cell) {
    return !map.contains(cell) || is_drivable(map.at(cell)) ||
           !any_overlaps_turning(pieces, about, turn_rad, cell);
  });
}

bool Footprint::is_clear_along(const OccupancyMap& map, const Path& path,
                               std::optional<double> start_heading_rad,
                               std::optional<double> final_heading_rad) const {
  if (path.waypoints_m.empty()) return true;
  Vec2 at_m = path.waypoints_m.front();
  std::optional<double> yaw_rad = start_heading_rad;
  for (const Vec2& next : path.waypoints_m) {
    const Vec2 leg = next - at_m;
    if (leg.isZero()) continue;
    const double heading_rad = heading_of(leg);
    if (yaw_rad && !is_clear_turning(map, {at_m, *yaw_rad}, heading_rad)) return false;
    if (!is_clear_driving(map, {at_m, heading_rad}, next)) return false;
    yaw_rad = heading_rad;
    at_m = next;
  }
  if (!yaw_rad) yaw_rad = final_heading_rad;
  return !yaw_rad || is_clear_turning(map, {at_m, *yaw_rad}, final_heading_rad.value_or(*yaw_rad));
}

std::vector<Cell> Footprint::cells_driving(double resolution_m, double heading_rad, Cell to) const {
  const Vec2 center = Vec2::Constant(0.5);
  const std::vector<Polygon> pieces =
      swept(placed(pieces_m_, {center * resolution_m, heading_rad}, resolution_m), Vec2(to.column, to.row));
  std::vector<Cell> cells;
  (void)all_within(bounds_of(pieces), [&](Cell cell) {
    if (any_overlaps(pieces, cell)) cells.push_back(cell);
    return true;
  });
  return cells;
}

std::vector<Cell> Footprint::cells_turning(double resolution_m, double heading_rad, double turn_rad) const {
  const Vec2 center = Vec2::Constant(0.5);
  const std::vector<Polygon> pieces = placed(pieces_m_, {center * resolution_m, heading_rad}, resolution_m);
  std::vector<Cell> cells;
  (void)all_within(bounds_of_circle(center, outer_radius_m() / resolution_m), [&](Cell cell) {
    if (any_overlaps_turning(pieces, center, turn_rad, cell)) cells.push_back(cell);
    return true;
  });
  return cells;
}

}  // namespace lodestar
