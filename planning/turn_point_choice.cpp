#include "planning/turn_point_choice.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Steps of 5 and 7 on tiles are up to 8 % longer than the straight line, and up to 1 % shorter than those of
/// 1 and sqrt(2).
constexpr double longest_share = 1.1;
constexpr double slack_tiles = 3.0;  ///< the ends may lie anywhere in their tiles
constexpr std::size_t most_tiles = 60000;

}  // namespace

/// Shortest first; among equals points farther from their corner, which need fewer turns.
struct TurnPointChoice::Earlier {
  bool operator()(const Ranked& a, const Ranked& b) const {
    if (a.through != b.through) return a.through < b.through;
    return a.tight != b.tight ? b.tight : a.index < b.index;
  }
};

TurnPointChoice::TurnPointChoice(const CollisionChecker& space, std::span<const TurnPoint> turn_points)
    : space_(space), turn_points_(turn_points), tiles_(space), from_start_(tiles_), from_goal_(tiles_) {}

double TurnPointChoice::at_least_cells(double over_tiles) const {
  return std::max(0.0, (over_tiles - slack_tiles * tiles_.side_cells()) / longest_share);
}

double TurnPointChoice::at_most_cells(double straight) const {
  return longest_share * straight + slack_tiles * tiles_.side_cells();
}

double TurnPointChoice::measured(const TileDistances& distances, const Vec2& point) const {
  constexpr double far = 1e9;
  return distances.at(tiles_.tile_at(point)).value_or(far);
}

const std::vector<TurnPlace>& TurnPointChoice::choose(std::span<const Vec2> known, double longest_cells,
                                                      bool counts_turns, std::size_t most) {
  measure(known.front(), known.back(), longest_cells);
  chosen_.clear();
  constexpr double open_share = 0.4;
  if (counts_turns)
    choose_open(static_cast<std::size_t>(open_share * static_cast<double>(most)), longest_cells);
  rank(counts_turns, longest_cells);
  choose_corners(most);
  return chosen_;
}

/// Sorted in portions, as most are never looked at.
void TurnPointChoice::choose_corners(std::size_t most) {
  auto sorted = ranked_.begin();
  for (auto next = ranked_.begin(); next != ranked_.end() && chosen_.size() < most; ++next) {
    if (next == sorted) {
      const auto left = ranked_.end() - sorted;
      sorted += std::min<std::ptrdiff_t>(left, static_cast<std::ptrdiff_t>(4 * most));
      std::ranges::partial_sort(next, sorted, ranked_.end(), Earlier{});
    }
    const TurnPoint& point = turn_points_[next->index];
    if (is_apart(point) && lets_bend(point)) chosen_.push_back({point.position, point.corner});
  }
}

/// On a lattice, so that a leg can pass between two corners without a turn at either.
void TurnPointChoice::choose_open(std::size_t most, double longest_cells) {
  constexpr int spacing = 2;  // tiles
  ranked_.clear();
  for (int row = 0; row < tiles_.rows(); row += spacing) {
    for (int column = 0; column < tiles_.columns(); column += spacing) {
      const Cell tile{column, row};
      const std::optional<std::int32_t> length = through(tile, longest_cells);
      if (length && space_.at(tiles_.middle_cell(tile)))
        ranked_.push_back({*length, false, static_cast<std::uint32_t>(tiles_.index(tile))});
    }
  }
  most = std::min(most, ranked_.size());
  std::ranges::partial_sort(ranked_, ranked_.begin() + static_cast<std::ptrdiff_t>(most), Earlier{});
  for (std::size_t i = 0; i < most; ++i)
    chosen_.push_back({center_of(tiles_.middle_cell(tiles_.tile(ranked_[i].index))), std::nullopt});
}

std::optional<std::int32_t> TurnPointChoice::through(Cell tile, double longest_cells) const {
  const std::optional<double> from_goal = from_goal_.at(tile);
  if (!from_goal) return std::nullopt;
  const std::optional<double> from_start = from_start_.at(tile);
  if (!from_start || *from_start + *from_goal >= at_most_cells(longest_cells)) return std::nullopt;
  return static_cast<std::int32_t>(8.0 / tiles_.side_cells() * (*from_start + *from_goal));
}

void TurnPointChoice::measure(const Vec2& start, const Vec2& goal, double longest_cells) {
  const double up_to_cells = at_most_cells(longest_cells);
  from_start_.measure(cell_at(start), up_to_cells, most_tiles);
  from_goal_.measure(cell_at(goal), up_to_cells, most_tiles, &from_start_);
}

void TurnPointChoice::rank(bool counts_turns, double longest_cells) {
  ranked_.clear();
  for (std::uint32_t i = 0; i < turn_points_.size(); ++i) {
    const TurnPoint& point = turn_points_[i];
    if (!point.tight && !counts_turns) continue;
    const std::optional<std::int32_t> length = through(tiles_.tile_at(point.position), longest_cells);
    if (length) ranked_.push_back({*length, point.tight, i});
  }
}

/// No other chosen point is so near that a path could as well turn there.
bool TurnPointChoice::is_apart(const TurnPoint& point) const {
  const double apart = std::max(1.0, 0.5 * space_.radius_cells());
  const Vec2 outwards = point.position - point.corner;
  return std::ranges::none_of(chosen_, [&](const TurnPlace& there) {
    return there.corner && (there.position - point.position).squaredNorm() < apart * apart &&
           outwards.dot(there.position - *there.corner) > 0.0;
  });
}

/// Whether a path can bend here by a noticeable angle around the corner. Along a ragged wall every bump is a
/// corner, but a bend around it soon runs into the next.
bool TurnPointChoice::lets_bend(const TurnPoint& point) const {
  constexpr double bend_rad = radians(10.0);  // on each side; or all of it on one
  const double length = 2.0 * space_.radius_cells();
  const Vec2 away = (point.position - point.corner).normalized();
  const Vec2 along(-away.y(), away.x());
  const auto clear = [&](double side, double down_rad) {
    const Vec2 way = side * std::cos(down_rad) * along - std::sin(down_rad) * away;
    return space_.along(point.position, point.position + length * way);
  };
  if (clear(1.0, bend_rad)) return clear(-1.0, bend_rad) || (clear(-1.0, 0.0) && clear(1.0, 2.0 * bend_rad));
  return clear(1.0, 0.0) && clear(-1.0, 2.0 * bend_rad);
}

}  // namespace lodestar
