#include "planning/collision_checker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "maps/distance_field.hpp"
#include "planning/touching.hpp"

namespace lodestar {
namespace {

constexpr double rounding = 1e-3;  ///< cells; generous to single precision

/// Distance from a point to the square of a cell, squared.
double squared_distance(const Vec2& point, Cell cell) {
  const double dx = std::max({cell.column - point.x(), point.x() - (cell.column + 1), 0.0});
  const double dy = std::max({cell.row - point.y(), point.y() - (cell.row + 1), 0.0});
  return dx * dx + dy * dy;
}

Vec2 nearest_on_leg(const Vec2& from, const Vec2& to, const Vec2& point) {
  const Vec2 leg = to - from;
  const double squared_length = leg.squaredNorm();
  if (squared_length == 0.0) return from;
  return from + std::clamp((point - from).dot(leg) / squared_length, 0.0, 1.0) * leg;
}

/// Does the leg cross the square? (clipping by Liang and Barsky)
bool crosses(const Vec2& from, const Vec2& to, Cell cell) {
  const Vec2 leg = to - from;
  double enter = 0.0;
  double leave = 1.0;
  const Vec2 low(cell.column, cell.row);
  for (int axis = 0; axis < 2; ++axis) {
    if (leg[axis] == 0.0) {
      if (from[axis] <= low[axis] || from[axis] >= low[axis] + 1.0) return false;
      continue;
    }
    const double a = (low[axis] - from[axis]) / leg[axis];
    const double b = (low[axis] + 1.0 - from[axis]) / leg[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

/// Is the square closer to the leg than the radius? When they do not intersect, the closest points are an end
/// of the leg and the square, or a corner of the square and the leg.
bool within(const Vec2& from, const Vec2& to, Cell cell, double radius) {
  const double limit = radius * radius;
  const Vec2 center = center_of(cell);
  const double far = radius + 0.5 * std::numbers::sqrt2 + rounding;  // beyond it, the square is out of reach
  if ((nearest_on_leg(from, to, center) - center).squaredNorm() > far * far) return false;
  if (squared_distance(from, cell) < limit || squared_distance(to, cell) < limit) return true;
  for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const Vec2 corner(cell.column + dx, cell.row + dy);
    if ((nearest_on_leg(from, to, corner) - corner).squaredNorm() < limit) return true;
  }
  return crosses(from, to, cell);
}

}  // namespace

CollisionChecker::CollisionChecker(const OccupancyMap& map, double radius_m)
    : map_(map),
      radius_cells_(std::max(radius_m / map.resolution_m - touching, touching)),
      clear_(map.cells.size(), 1),
      regions_(map.cells.size(), 0),
      to_obstacle_(map.cells.size()) {
  measure_distances();
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      if (!is_drivable(map_.at({column, row}))) block_around({column, row});
    }
  }
  block_border();
  label_regions();
}

void CollisionChecker::measure_distances() {
  const DistanceField field(map_);
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      to_obstacle_[map_.index({column, row})] =
          std::sqrt(static_cast<float>(field.squared_cells({column, row})));
    }
  }
}

/// Obstacle cells enclosed by obstacles are skipped, as their neighbours block the same cells.
void CollisionChecker::block_around(Cell obstacle) {
  constexpr std::array<Cell, 4> sides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const bool at_edge = std::ranges::any_of(sides, [&](Cell side) {
    const Cell beside{obstacle.column + side.column, obstacle.row + side.row};
    return map_.contains(beside) && is_drivable(map_.at(beside));
  });
  clear_[map_.index(obstacle)] = 0;
  if (!at_edge) return;
  const int reach = static_cast<int>(std::ceil(radius_cells_ + 0.5));
  for (int dy = -reach; dy <= reach; ++dy) {
    const int row = obstacle.row + dy;
    if (row < 0 || row >= map_.rows) continue;
    const double up = std::max(std::abs(dy) - 0.5, 0.0);
    if (up >= radius_cells_) continue;
    // In this row, centres within this column distance are blocked.
    const double across = std::sqrt(radius_cells_ * radius_cells_ - up * up) + 0.5;
    const int span = static_cast<int>(std::ceil(across)) - 1;
    const int first = std::max(obstacle.column - span, 0);
    const int last = std::min(obstacle.column + span, map_.columns - 1);
    for (int column = first; column <= last; ++column) clear_[map_.index({column, row})] = 0;
  }
}

void CollisionChecker::block_border() {
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      const double margin = 0.5 + std::min({column, row, map_.columns - 1 - column, map_.rows - 1 - row});
      if (margin < radius_cells_) clear_[map_.index({column, row})] = 0;
    }
  }
}

void CollisionChecker::label_regions() {
  int label = 0;
  for (int row = 0; row < map_.rows; ++row) {
    for (int column = 0; column < map_.columns; ++column) {
      if (at({column, row}) && region({column, row}) == 0) flood({column, row}, ++label);
    }
  }
}

/// 4-connected flood fill: a diagonal step needs both cells beside it to be clear as well.
void CollisionChecker::flood(Cell seed, int label) {
  std::vector<Cell> open{seed};
  regions_[map_.index(seed)] = label;
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (const Cell next : {Cell{cell.column + 1, cell.row}, Cell{cell.column - 1, cell.row},
                            Cell{cell.column, cell.row + 1}, Cell{cell.column, cell.row - 1}}) {
      if (!at(next) || region(next) != 0) continue;
      regions_[map_.index(next)] = label;
      open.push_back(next);
    }
  }
}

/// Walks the leg by the distance field: in long strides far from obstacles, elsewhere cell by cell. Only
/// stretches near an obstacle are checked square by square.
bool CollisionChecker::along(const Vec2& from, const Vec2& to) const {
  if (!from.allFinite() || !to.allFinite()) return false;
  const Vec2 low = from.cwiseMin(to).array() - radius_cells_;
  const Vec2 high = from.cwiseMax(to).array() + radius_cells_;
  if (low.minCoeff() < 0.0 || high.x() > map_.columns || high.y() > map_.rows) return false;
  const double length = (to - from).norm();
  const Vec2 step = length > 0.0 ? Vec2((to - from) / length) : Vec2::Zero();
  std::optional<double> near_since;
  for (double at = 0.0; at <= length;) {
    const Vec2 point = from + at * step;
    const Cell cell{std::min(static_cast<int>(point.x()), map_.columns - 1),
                    std::min(static_cast<int>(point.y()), map_.rows - 1)};
    const double to_obstacle = static_cast<double>(to_obstacle_[map_.index(cell)]);  // centre to centre
    const double sure_stride = to_obstacle - std::numbers::sqrt2 - radius_cells_ - rounding;
    if (sure_stride >= 1.0 && !near_since) {
      at += sure_stride;
      continue;
    }
    const double off_center = (point - center_of(cell)).norm();
    // A square's edge is between half a side and half a diagonal from its centre.
    if (to_obstacle + off_center + rounding < radius_cells_ + 0.5) return false;
    const double stride = to_obstacle - off_center - 0.5 * std::numbers::sqrt2 - radius_cells_ - rounding;
    if (stride >= 1.0) {
      if (near_since && !stretch_is_clear(from + *near_since * step, point)) return false;
      near_since.reset();
    } else if (!near_since) {
      near_since = at;
    }
    at += std::max(stride, 1.0);
  }
  return !near_since || stretch_is_clear(from + *near_since * step, to);
}

bool CollisionChecker::stretch_is_clear(const Vec2& from, const Vec2& to) const {
  const int first = std::max(static_cast<int>(std::min(from.y(), to.y()) - radius_cells_), 0);
  const int last = std::min(static_cast<int>(std::max(from.y(), to.y()) + radius_cells_), map_.rows - 1);
  for (int row = first; row <= last; ++row) {
    if (!row_is_clear(row, from, to)) return false;
  }
  return true;
}

/// Only the part of the leg that passes within the radius of the row can touch it there.
bool CollisionChecker::row_is_clear(int row, const Vec2& from, const Vec2& to) const {
  double enter = 0.0;
  double leave = 1.0;
  if (to.y() != from.y()) {
    const double share_per_row = 1.0 / (to.y() - from.y());
    const double a = (row - radius_cells_ - from.y()) * share_per_row;
    const double b = (row + 1 + radius_cells_ - from.y()) * share_per_row;
    enter = std::clamp(std::min(a, b), 0.0, 1.0);
    leave = std::clamp(std::max(a, b), 0.0, 1.0);
  }
  const double x_enter = from.x() + enter * (to.x() - from.x());
  const double x_leave = from.x() + leave * (to.x() - from.x());
  const int first = std::max(static_cast<int>(std::min(x_enter, x_leave) - radius_cells_), 0);
  const int last = std::min(static_cast<int>(std::max(x_enter, x_leave) + radius_cells_), map_.columns - 1);
  for (int column = first; column <= last; ++column) {
    const Cell cell{column, row};
    if (!is_drivable(map_.at(cell)) && within(from, to, cell, radius_cells_)) return false;
  }
  return true;
}

}  // namespace lodestar
