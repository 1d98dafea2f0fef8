#include "planning/collision_checker.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "maps/segment.hpp"
#include "maps/touching.hpp"

namespace lodestar {
namespace {

constexpr double rounding = 1e-3;  ///< cells; generous to single precision

/// Distance from a point to the square of a cell, squared.
double squared_distance(const Vec2& point, Cell cell) {
  const double dx = std::max({cell.column - point.x(), point.x() - (cell.column + 1), 0.0});
  const double dy = std::max({cell.row - point.y(), point.y() - (cell.row + 1), 0.0});
  return dx * dx + dy * dy;
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
  if ((nearest_on_segment(from, to, center) - center).squaredNorm() > far * far) return false;
  if (squared_distance(from, cell) < limit || squared_distance(to, cell) < limit) return true;
  for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const Vec2 corner(cell.column + dx, cell.row + dy);
    if ((nearest_on_segment(from, to, corner) - corner).squaredNorm() < limit) return true;
  }
  return crosses(from, to, cell);
}

}  // namespace

CollisionChecker::CollisionChecker(std::shared_ptr<const ObstacleField> field, double radius_m)
    : field_(std::move(field)),
      map_(field_->map()),
      radius_cells_(std::max(radius_m / map_.resolution_m - touching, touching)),
      words_a_row_((static_cast<std::size_t>(map_.columns) + 63U) / 64U),
      clear_(words_a_row_ * static_cast<std::size_t>(map_.rows), 0) {
  clear_drivable();
  block_around_obstacles();
  block_border();
  regions_ = Regions(clear_, map_.columns, map_.rows);
}

CollisionChecker::CollisionChecker(const OccupancyMap& map, double radius_m)
    : CollisionChecker(std::make_shared<const ObstacleField>(map), radius_m) {}

void CollisionChecker::clear_drivable() {
  const auto used = static_cast<unsigned>(map_.columns % 64);
  for (int row = 0; row < map_.rows; ++row) {
    const std::span<const std::uint64_t> obstacles = field_->obstacles(row);
    std::ranges::transform(obstacles, clear_.begin() + static_cast<std::ptrdiff_t>(word(row)),
                           [](std::uint64_t bits) { return ~bits; });
    if (used != 0) clear_[word(row) + words_a_row_ - 1] &= (std::uint64_t{1} << used) - 1U;
  }
}

/// Obstacle cells enclosed by obstacles are skipped, as their neighbours block the same cells.
void CollisionChecker::block_around_obstacles() {
  for (double up = 0.0; up < radius_cells_; up = static_cast<double>(spans_.size()) - 0.5) {
    // In this row, centres within this column distance are blocked.
    const double across = std::sqrt(radius_cells_ * radius_cells_ - up * up) + 0.5;
    spans_.push_back(static_cast<int>(std::ceil(across)) - 1);
  }
  const std::vector<std::uint64_t> outside(words_a_row_, ~std::uint64_t{0});
  for (int row = 0; row < map_.rows; ++row) {
    const std::span<const std::uint64_t> here = field_->obstacles(row);
    const std::span<const std::uint64_t> below = row > 0 ? field_->obstacles(row - 1) : outside;
    const std::span<const std::uint64_t> above = row + 1 < map_.rows ? field_->obstacles(row + 1) : outside;
    for (std::size_t i = 0; i < words_a_row_; ++i) {
      const std::uint64_t left = here[i] << 1U | (i > 0 ? here[i - 1] >> 63U : 1U);
      std::uint64_t right = here[i] >> 1U | (i + 1 < words_a_row_ ? here[i + 1] << 63U : 0U);
      if (i + 1 == words_a_row_) right |= std::uint64_t{1} << static_cast<unsigned>((map_.columns - 1) % 64);
      std::uint64_t at_edge = here[i] & ~(left & right & below[i] & above[i]);
      for (; at_edge != 0; at_edge &= at_edge - 1)
        block_around({static_cast<int>(i) * 64 + std::countr_zero(at_edge), row});
    }
  }
}

void CollisionChecker::block_around(Cell obstacle) {
  const int reach = static_cast<int>(spans_.size()) - 1;
  const int low = std::max(obstacle.row - reach, 0);
  const int high = std::min(obstacle.row + reach, map_.rows - 1);
  for (int row = low; row <= high; ++row) {
    const int span = spans_[static_cast<std::size_t>(std::abs(row - obstacle.row))];
    block(row, std::max(obstacle.column - span, 0), std::min(obstacle.column + span, map_.columns - 1));
  }
}

void CollisionChecker::block_border() {
  for (int i = 0; 0.5 + i < radius_cells_ && i < std::max(map_.rows, map_.columns); ++i) {
    if (i < map_.rows) {
      block(i, 0, map_.columns - 1);
      block(map_.rows - 1 - i, 0, map_.columns - 1);
    }
    if (i >= map_.columns) continue;
    for (int row = 0; row < map_.rows; ++row) {
      block(row, i, i);
      block(row, map_.columns - 1 - i, map_.columns - 1 - i);
    }
  }
}

void CollisionChecker::block(int row, int first, int last) {
  const std::size_t begin = word(row);
  for (int i = first / 64; i <= last / 64; ++i) {
    std::uint64_t bits = ~std::uint64_t{0};
    if (i == first / 64) bits &= ~std::uint64_t{0} << static_cast<unsigned>(first % 64);
    if (i == last / 64) bits &= ~std::uint64_t{0} >> static_cast<unsigned>(63 - last % 64);
    clear_[begin + static_cast<std::size_t>(i)] &= ~bits;
  }
}

/// A square's edge is between half a side and half a diagonal from its centre.
bool CollisionChecker::is_surely_blocked_at(const Vec2& point) const {
  const Cell cell{static_cast<int>(point.x()), static_cast<int>(point.y())};
  const std::size_t index = map_.index(cell);
  const double to_obstacle = field_->distance_cells(index);
  return field_->squared_cells(index) != ObstacleField::far &&
         to_obstacle + (point - center_of(cell)).norm() + rounding < radius_cells_ + 0.5;
}

bool CollisionChecker::is_surely_blocked(const Vec2& from, const Vec2& to) const {
  const auto is_on_map = [&](const Vec2& point) {
    return point.x() >= 0.0 && point.y() >= 0.0 && point.x() < map_.columns && point.y() < map_.rows;
  };
  if (!is_on_map(from) || !is_on_map(to)) return true;
  const Vec2 leg = to - from;
  for (const double at : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875})
    if (is_surely_blocked_at(from + at * leg)) return true;
  return false;
}

/// Walks the leg by the distance field: in long strides far from obstacles. Only stretches near an obstacle
/// are checked square by square.
bool CollisionChecker::along(const Vec2& from, const Vec2& to) const {
  if (!from.allFinite() || !to.allFinite()) return false;
  const Vec2 low = from.cwiseMin(to).array() - radius_cells_;
  const Vec2 high = from.cwiseMax(to).array() + radius_cells_;
  if (low.minCoeff() < 0.0 || high.x() > map_.columns || high.y() > map_.rows) return false;
  const double length = (to - from).norm();
  const Vec2 step = length > 0.0 ? Vec2((to - from) / length) : Vec2::Zero();
  const double near_stride = std::max(1.0, 0.5 * radius_cells_);
  std::optional<double> near_since;
  for (double at = 0.0; at <= length;) {
    const Vec2 point = from + at * step;
    const Cell cell{std::min(static_cast<int>(point.x()), map_.columns - 1),
                    std::min(static_cast<int>(point.y()), map_.rows - 1)};
    const std::size_t index = map_.index(cell);
    const double to_obstacle = field_->distance_cells(index);  // centre to centre, or less
    const double sure_stride = to_obstacle - std::numbers::sqrt2 - radius_cells_ - rounding;
    if (sure_stride >= 1.0 && !near_since) {
      at += sure_stride;
      continue;
    }
    const double off_center = (point - center_of(cell)).norm();
    const bool is_exact = field_->squared_cells(index) != ObstacleField::far;
    if (is_exact && to_obstacle + off_center + rounding < radius_cells_ + 0.5) return false;
    const double stride = to_obstacle - off_center - 0.5 * std::numbers::sqrt2 - radius_cells_ - rounding;
    if (stride >= 1.0) {
      if (near_since && !stretch_is_clear(from + *near_since * step, point)) return false;
      near_since.reset();
      at += stride;
      continue;
    }
    if (!near_since) near_since = at;
    at += near_stride;
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
  const std::span<const std::uint64_t> words = field_->obstacles(row);
  for (int i = first / 64; i <= last / 64; ++i) {
    std::uint64_t bits = words[static_cast<std::size_t>(i)];
    if (i == first / 64) bits &= ~std::uint64_t{0} << static_cast<unsigned>(first % 64);
    if (i == last / 64) bits &= ~std::uint64_t{0} >> static_cast<unsigned>(63 - last % 64);
    for (; bits != 0; bits &= bits - 1) {
      if (within(from, to, {64 * i + std::countr_zero(bits), row}, radius_cells_)) return false;
    }
  }
  return true;
}

}  // namespace lodestar
