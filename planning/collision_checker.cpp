#include "planning/collision_checker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "maps/touching.hpp"
#include "planning/bit_words.hpp"
#include "planning/swept_disc.hpp"

namespace lodestar {
namespace {

constexpr double rounding = 1e-3;  ///< cells; generous to single precision

/// The first bit set whose cell overlaps an extent in x, both ends on the row; -1 for none.
int first_set(std::span<const std::uint64_t> row, double least_x, double greatest_x) {
  const int first = std::max(static_cast<int>(least_x), 0);
  int last = static_cast<int>(greatest_x);
  if (last == greatest_x) --last;  // touches the next cell only
  last = std::min(last, 64 * static_cast<int>(row.size()) - 1);
  for (int i = first / 64; i <= last / 64; ++i) {
    const std::uint64_t bits = row[static_cast<std::size_t>(i)] & bits_between(i, first, last);
    if (bits != 0) return 64 * i + std::countr_zero(bits);
  }
  return -1;
}

/// The first obstacle that the disc overlaps on a stretch, by lines of cells along x.
template <typename LineOfCells>
std::optional<Cell> first_on_lines(const Vec2& from, const Vec2& to, double radius, int lines,
                                   const LineOfCells& line) {
  const SweptDisc swept(from, to, radius);
  const int first = std::max(static_cast<int>(swept.lowest_y()), 0);
  const int last = std::min(static_cast<int>(swept.highest_y()), lines - 1);
  for (int at = first; at <= last; ++at) {
    const double least_x = swept.least_x(at, at + 1);
    const double greatest_x = swept.greatest_x(at, at + 1);
    if (greatest_x <= least_x) continue;
    if (const int place = first_set(line(at), least_x, greatest_x); place >= 0) return Cell{place, at};
  }
  return std::nullopt;
}

}  // namespace

CollisionChecker::CollisionChecker(std::shared_ptr<const ObstacleField> field, double radius_m)
    : field_(std::move(field)),
      map_(field_->map()),
      radius_cells_(std::max(radius_m / map_.resolution_m - touching, touching)),
      words_a_row_((static_cast<std::size_t>(map_.columns) + 63U) / 64U),
      clear_(words_a_row_ * static_cast<std::size_t>(map_.rows), 0),
      in_part_clear_(clear_.size(), ~std::uint64_t{0}) {
  clear_drivable();
  block_around_obstacles();
  block_border(radius_cells_, clear_);
  block_border(in_part_cells(), in_part_clear_);
  regions_ = Regions(clear_, map_.columns, map_.rows);
}

CollisionChecker::CollisionChecker(const OccupancyMap& map, double radius_m)
    : CollisionChecker(std::make_shared<const ObstacleField>(map), radius_m) {}

/// A disc anywhere in a cell is blocked by what is nearer to the cell's centre than this.
double CollisionChecker::in_part_cells() const {
  return radius_cells_ - 0.5 * std::numbers::sqrt2 - rounding;
}

void CollisionChecker::clear_drivable() {
  const auto used = static_cast<unsigned>(map_.columns % 64);
  for (int row = 0; row < map_.rows; ++row) {
    const std::span<const std::uint64_t> obstacles = field_->obstacles(row);
    std::ranges::transform(obstacles, clear_.begin() + static_cast<std::ptrdiff_t>(word(row)),
                           [](std::uint64_t bits) { return ~bits; });
    if (used != 0) clear_[word(row) + words_a_row_ - 1] &= (std::uint64_t{1} << used) - 1U;
  }
}

/// For each row up from an obstacle's: how many columns to each side a cell is blocked whose centre is nearer
/// to the obstacle than this.
std::vector<int> CollisionChecker::spans_within(double distance_cells) {
  std::vector<int> spans;
  for (double up = 0.0; up < distance_cells; up = static_cast<double>(spans.size()) - 0.5) {
    const double across = std::sqrt(distance_cells * distance_cells - up * up) + 0.5;
    spans.push_back(static_cast<int>(std::ceil(across)) - 1);
  }
  return spans;
}

/// Obstacle cells enclosed by obstacles are skipped, as their neighbours block the same cells.
void CollisionChecker::block_around_obstacles() {
  const std::vector<int> spans = spans_within(radius_cells_);
  const std::vector<int> whole_spans = spans_within(in_part_cells());
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
      for (; at_edge != 0; at_edge &= at_edge - 1) {
        const Cell obstacle{static_cast<int>(i) * 64 + std::countr_zero(at_edge), row};
        block_around(obstacle, spans, clear_);
        block_around(obstacle, whole_spans, in_part_clear_);
      }
    }
  }
}

void CollisionChecker::block_around(Cell obstacle, std::span<const int> spans,
                                    std::vector<std::uint64_t>& bits) {
  const int reach = static_cast<int>(spans.size()) - 1;
  const int low = std::max(obstacle.row - reach, 0);
  const int high = std::min(obstacle.row + reach, map_.rows - 1);
  for (int row = low; row <= high; ++row) {
    const int span = spans[static_cast<std::size_t>(std::abs(row - obstacle.row))];
    block(row, std::max(obstacle.column - span, 0), std::min(obstacle.column + span, map_.columns - 1), bits);
  }
}

/// Outside the map is obstacle: blocks the cells whose centre is nearer to it than this.
void CollisionChecker::block_border(double distance_cells, std::vector<std::uint64_t>& bits) {
  for (int i = 0; 0.5 + i < distance_cells && i < std::max(map_.rows, map_.columns); ++i) {
    if (i < map_.rows) {
      block(i, 0, map_.columns - 1, bits);
      block(map_.rows - 1 - i, 0, map_.columns - 1, bits);
    }
    if (i >= map_.columns) continue;
    for (int row = 0; row < map_.rows; ++row) {
      block(row, i, i, bits);
      block(row, map_.columns - 1 - i, map_.columns - 1 - i, bits);
    }
  }
}

void CollisionChecker::block(int row, int first, int last, std::vector<std::uint64_t>& bits) {
  const std::size_t begin = word(row);
  for (int i = first / 64; i <= last / 64; ++i)
    bits[begin + static_cast<std::size_t>(i)] &= ~bits_between(i, first, last);
}

bool CollisionChecker::is_surely_blocked(const Vec2& from, const Vec2& to) const {
  const auto is_on_map = [&](const Vec2& point) {
    return point.x() >= 0.0 && point.y() >= 0.0 && point.x() < map_.columns && point.y() < map_.rows;
  };
  if (!is_on_map(from) || !is_on_map(to)) return true;
  const Vec2 leg = to - from;
  const auto is_blocked = [&](double share) {
    const Vec2 point = from + share * leg;
    return !is_in_part_clear({static_cast<int>(point.x()), static_cast<int>(point.y())});
  };
  for (const double share : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875, 0.0625, 0.1875, 0.3125, 0.4375,
                             0.5625, 0.6875, 0.8125, 0.9375})
    if (is_blocked(share)) return true;
  return false;
}

/// By sure strides where there is room; near obstacles by exact looks at longer and longer stretches.
double CollisionChecker::clear_length(const Vec2& from, const Vec2& direction) const {
  const double least_look = std::max(0.25, 0.5 * radius_cells_);
  constexpr double least_stride = 1.0;
  const double to_border = length_to_border(from, direction);
  double length = 0.0;
  double look = radius_cells_;
  while (length < to_border) {
    const Vec2 point = from + length * direction;
    const Cell cell = cell_at(point);
    const double to_obstacle = field_->distance_cells(map_.index(cell)) - (point - center_of(cell)).norm();
    const double stride = to_obstacle - 0.5 * std::numbers::sqrt2 - radius_cells_ - rounding;
    if (stride >= least_stride) {
      length += stride;
      continue;
    }
    look = std::min(std::max(look, least_look), to_border - length);
    bool is_blocked = false;
    while (obstacle_on_stretch(point, point + look * direction)) {
      is_blocked = true;
      look *= 0.5;
      if (look < least_look) return length;
    }
    length += look;
    if (!is_blocked) look *= 2.0;
  }
  return to_border;
}

/// How far a disc can go before it leaves the map; 0 where it is not within.
double CollisionChecker::length_to_border(const Vec2& from, const Vec2& direction) const {
  const Vec2 low = Vec2::Constant(radius_cells_);
  const Vec2 high = Vec2(map_.columns, map_.rows) - low;
  if ((from - low).minCoeff() < 0.0 || (high - from).minCoeff() < 0.0) return 0.0;
  double length = std::hypot(map_.columns, map_.rows);
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double border = direction[axis] > 0.0 ? high[axis] : low[axis];
    length = std::min(length, (border - from[axis]) / direction[axis]);
  }
  return std::max(length - rounding, 0.0);
}

bool CollisionChecker::is_blocked_by(Cell obstacle, const Vec2& from, const Vec2& to) const {
  const SweptDisc swept(from, to, radius_cells_);
  const int row = obstacle.row;
  return swept.lowest_y() < row + 1 && swept.highest_y() > row &&
         swept.least_x(row, row + 1) < obstacle.column + 1 &&
         swept.greatest_x(row, row + 1) > obstacle.column;
}

bool CollisionChecker::along(const Vec2& from, const Vec2& to) const {
  std::optional<Cell> ignored;
  return along(from, to, ignored);
}

/// Walks the leg by the distance field: in long strides far from obstacles. Only stretches near an obstacle
/// are checked square by square.
bool CollisionChecker::along(const Vec2& from, const Vec2& to, std::optional<Cell>& blocking) const {
  if (!from.allFinite() || !to.allFinite()) return false;
  const Vec2 low = from.cwiseMin(to).array() - radius_cells_;
  const Vec2 high = from.cwiseMax(to).array() + radius_cells_;
  if (low.minCoeff() < 0.0 || high.x() > map_.columns || high.y() > map_.rows) return false;
  const double length = (to - from).norm();
  constexpr double worth_a_look = 4.0;  // cells
  if (length > worth_a_look && is_surely_blocked(from, to)) return false;
  const Vec2 step = length > 0.0 ? Vec2((to - from) / length) : Vec2::Zero();
  const double near_stride = std::max(1.0, 0.5 * radius_cells_);
  // Shorter strides cost more than an exact look at the way; so does leaving a stretch near obstacles for one
  // that is no longer than those on it, for each stretch has two round ends.
  constexpr double least_stride = 0.5;
  std::optional<double> near_since;
  for (double at = 0.0; at <= length;) {
    const Vec2 point = from + at * step;
    const Cell cell{std::min(static_cast<int>(point.x()), map_.columns - 1),
                    std::min(static_cast<int>(point.y()), map_.rows - 1)};
    const std::size_t index = map_.index(cell);
    const double to_obstacle = field_->distance_cells(index);  // centre to centre, or less
    const double sure_stride = to_obstacle - std::numbers::sqrt2 - radius_cells_ - rounding;
    if (sure_stride >= least_stride && !near_since) {
      at += sure_stride;
      continue;
    }
    const double off_center = (point - center_of(cell)).norm();
    const bool is_exact = field_->squared_cells(index) != ObstacleField::far;
    if (is_exact && to_obstacle + off_center + rounding < radius_cells_ + 0.5) return false;
    const double stride = to_obstacle - off_center - 0.5 * std::numbers::sqrt2 - radius_cells_ - rounding;
    if (stride >= (near_since ? near_stride : least_stride)) {
      if (near_since) {
        const std::optional<Cell> obstacle = obstacle_on_stretch(from + *near_since * step, point);
        if (obstacle) {
          blocking = obstacle;
          return false;
        }
      }
      near_since.reset();
      at += stride;
      continue;
    }
    if (!near_since) near_since = at;
    at += near_stride;
  }
  if (!near_since) return true;
  const std::optional<Cell> obstacle =
      length > 0.0 ? obstacle_on_stretch(from + *near_since * step, to) : obstacle_around(to);
  if (obstacle) blocking = obstacle;
  return !obstacle;
}

std::optional<Cell> CollisionChecker::obstacle_around(const Vec2& point) const {
  const int first = std::max(static_cast<int>(point.y() - radius_cells_), 0);
  const int last = std::min(static_cast<int>(point.y() + radius_cells_), map_.rows - 1);
  for (int row = first; row <= last; ++row) {
    const double up = point.y() - std::clamp(point.y(), static_cast<double>(row), row + 1.0);
    const double squared = radius_cells_ * radius_cells_ - up * up;
    if (squared <= 0.0) continue;
    const double across = std::sqrt(squared);
    const int column = first_set(field_->obstacles(row), point.x() - across, point.x() + across);
    if (column >= 0) return Cell{column, row};
  }
  return std::nullopt;
}

/// By the columns where the stretch is steep, so that its lines are few and long.
std::optional<Cell> CollisionChecker::obstacle_on_stretch(const Vec2& from, const Vec2& to) const {
  if (std::abs(to.y() - from.y()) > std::abs(to.x() - from.x())) {
    const auto column = [&](int at) { return field_->obstacles_of_column(at); };
    const std::optional<Cell> found =
        first_on_lines({from.y(), from.x()}, {to.y(), to.x()}, radius_cells_, map_.columns, column);
    return found ? std::optional(Cell{found->row, found->column}) : std::nullopt;
  }
  return first_on_lines(from, to, radius_cells_, map_.rows, [&](int at) { return field_->obstacles(at); });
}

}  // namespace lodestar
