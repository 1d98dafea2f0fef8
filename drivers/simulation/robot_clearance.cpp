#include "drivers/simulation/robot_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "maps/segment.hpp"

namespace lodestar {
namespace {

using Corners = std::vector<Vec2>;

bool sides_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
}

/// Between two outlines; 0 when they overlap.
double outlines_apart_m(const Corners& a, const Corners& b) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Vec2& corner : a) nearest_m = std::min(nearest_m, distance_to_outline(b, corner));
  for (const Vec2& corner : b) nearest_m = std::min(nearest_m, distance_to_outline(a, corner));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      if (sides_cross(a[i], a[(i + 1) % a.size()], b[k], b[(k + 1) % b.size()])) return 0.0;
  return std::max(0.0, nearest_m);
}

}  // namespace

RobotClearance::RobotClearance(const OccupancyMap& map, double robot_radius_m,
                               std::optional<Footprint> footprint)
    : map_(map), robot_radius_m_(robot_radius_m), footprint_(std::move(footprint)) {}

double RobotClearance::outer_radius_m() const {
  return footprint_ ? footprint_->outer_radius_m() : robot_radius_m_;
}

double RobotClearance::to_disc_m(const Pose2& map_from_base, const Vec2& center_m, double radius_m) const {
  if (!footprint_) return (center_m - map_from_base.position_m).norm() - radius_m - robot_radius_m_;
  return distance_to_outline(footprint_->corners_m(), inverse(map_from_base) * center_m) - radius_m;
}

double RobotClearance::to_cell_m(const Pose2& map_from_base, Cell cell) const {
  const std::array<Vec2, 4> in_grid{Vec2(cell.column, cell.row), Vec2(cell.column + 1, cell.row),
                                    Vec2(cell.column + 1, cell.row + 1), Vec2(cell.column, cell.row + 1)};
  const Pose2 base_from_grid = inverse(map_from_base) * map_.map_from_grid;
  Corners in_base;
  for (const Vec2& corner : in_grid) in_base.push_back(base_from_grid * Vec2(corner * map_.resolution_m));
  if (footprint_) return outlines_apart_m(in_base, footprint_->corners_m());
  return std::max(0.0, distance_to_outline(in_base, Vec2::Zero()) - robot_radius_m_);
}

std::optional<double> RobotClearance::to_map_m(const Pose2& map_from_base, double most_m) const {
  const Vec2 at = inverse(map_.map_from_grid) * map_from_base.position_m / map_.resolution_m;
  const double reach = (outer_radius_m() + most_m) / map_.resolution_m;
  if (!at.allFinite() || !std::isfinite(reach)) return std::nullopt;
  const auto cell_of = [](double coordinate, int count) {
    return static_cast<int>(std::clamp(std::floor(coordinate), 0.0, static_cast<double>(count)));
  };
  std::optional<double> nearest_m;
  for (int row = cell_of(at.y() - reach, map_.rows); row < cell_of(at.y() + reach + 1.0, map_.rows); ++row) {
    for (int column = cell_of(at.x() - reach, map_.columns);
         column < cell_of(at.x() + reach + 1.0, map_.columns); ++column) {
      if (is_drivable(map_.at({column, row}))) continue;
      const double least_m =
          ((center_of(Cell{column, row}) - at).norm() - std::sqrt(0.5)) * map_.resolution_m;
      const double limit_m = nearest_m.value_or(most_m);
      if (least_m - outer_radius_m() >= limit_m) continue;
      const double apart_m = to_cell_m(map_from_base, {column, row});
      if (apart_m < limit_m) nearest_m = apart_m;
    }
  }
  return nearest_m;
}

}  // namespace lodestar
