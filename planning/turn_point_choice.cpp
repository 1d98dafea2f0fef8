#include "planning/turn_point_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestar {
namespace {

/// Steps of 5 and 7 on tiles are up to 8 % longer than the straight line, and up to 1 % shorter than those of
/// 1 and sqrt(2).
constexpr double longest_share = 1.1;
constexpr double slack_tiles = 3.0;  ///< the ends may lie anywhere in their tiles
constexpr std::size_t most_tiles = 60000;

}  // namespace

/// Shortest first.
struct TurnPointChoice::Earlier {
  bool operator()(const Ranked& a, const Ranked& b) const {
    return a.through != b.through ? a.through < b.through : a.tile < b.tile;
  }
};

TurnPointChoice::TurnPointChoice(const CollisionChecker& space, std::span<const TurnPoint> turn_points)
    : space_(space),
      turn_points_(turn_points),
      tiles_(space),
      bends_(turn_points.size(), Bend::unknown),
      from_start_(tiles_),
      from_goal_(tiles_),
      newest_of_tile_(tiles_.size(), none) {
  sort_into_tiles();
}

/// Among the points of a tile those farther from their corner come first, which need fewer turns.
void TurnPointChoice::sort_into_tiles() {
  const auto tile_of = [&](const TurnPoint& point) { return tiles_.index(tiles_.tile_at(point.position)); };
  std::vector<std::uint32_t> next(tiles_.size() + 1, 0);
  for (const TurnPoint& point : turn_points_) ++next[tile_of(point) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  first_of_tile_ = next;
  by_tile_.resize(turn_points_.size());
  for (const bool tight : {false, true})
    for (std::uint32_t i = 0; i < turn_points_.size(); ++i)
      if (turn_points_[i].tight == tight) by_tile_[next[tile_of(turn_points_[i])]++] = i;
}

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
                                                      bool counts_turns, std::size_t most, int round) {
  if (round == 0) measure(known.front(), known.back(), longest_cells);
  forget_chosen();
  constexpr double open_share = 0.4;
  if (counts_turns)
    choose_open(static_cast<std::size_t>(open_share * static_cast<double>(most)), longest_cells, round);
  rank_tiles(longest_cells);
  choose_corners(most, counts_turns);
  return chosen_;
}

void TurnPointChoice::forget_chosen() {
  for (const TurnPlace& place : chosen_) newest_of_tile_[tiles_.index(tiles_.tile_at(place.position))] = none;
  chosen_.clear();
  older_of_tile_.clear();
}

/// Sorted in portions, as most are never looked at.
void TurnPointChoice::choose_corners(std::size_t most, bool counts_turns) {
  auto sorted = ranked_.begin();
  for (auto next = ranked_.begin(); next != ranked_.end() && chosen_.size() < most; ++next) {
    if (next == sorted) {
      const auto left = ranked_.end() - sorted;
      sorted += std::min<std::ptrdiff_t>(left, static_cast<std::ptrdiff_t>(most));
      std::ranges::partial_sort(next, sorted, ranked_.end(), Earlier{});
    }
    choose_corners_of(next->tile, most, counts_turns);
  }
}

void TurnPointChoice::choose_corners_of(std::uint32_t tile, std::size_t most, bool counts_turns) {
  older_of_tile_.resize(chosen_.size(), none);  // open ones are in no list
  for (std::uint32_t i = first_of_tile_[tile]; i < first_of_tile_[tile + 1] && chosen_.size() < most; ++i) {
    const TurnPoint& point = turn_points_[by_tile_[i]];
    if (!point.tight && !counts_turns) continue;
    if (!is_apart(point, tile) || !lets_bend(by_tile_[i])) continue;
    older_of_tile_.push_back(newest_of_tile_[tile]);
    newest_of_tile_[tile] = static_cast<std::uint32_t>(chosen_.size());
    chosen_.push_back({point.position, point.corner});
  }
}

/// On a lattice, so that a leg can pass between two corners without a turn at either; so wide that they lie
/// all over the ground that a cheaper path may use: the shortest way is not always the fastest.
void TurnPointChoice::choose_open(std::size_t most, double longest_cells, int round) {
  constexpr int densest = 2;  // tiles
  constexpr int widest = 12;
  constexpr double dropped = 1.5;  // so many times the wanted ones still count as spread
  int spacing = densest;
  rank_open(spacing, round, longest_cells);
  while (spacing<widest&& static_cast<double>(ranked_.size())> dropped * static_cast<double>(most))
    rank_open(++spacing, round, longest_cells);
  most = std::min(most, ranked_.size());
  std::ranges::partial_sort(ranked_, ranked_.begin() + static_cast<std::ptrdiff_t>(most), Earlier{});
  for (std::size_t i = 0; i < most; ++i)
    chosen_.push_back({center_of(tiles_.middle_cell(tiles_.tile(ranked_[i].tile))), std::nullopt});
}

/// Each round has its own offset of the lattice.
void TurnPointChoice::rank_open(int spacing, int round, double longest_cells) {
  ranked_.clear();
  for (int row = (round + 1) / 2 % spacing; row < tiles_.rows(); row += spacing) {
    for (int column = round * spacing / 2 % spacing; column < tiles_.columns(); column += spacing) {
      const Cell tile{column, row};
      const std::optional<std::int32_t> length = through(tile, longest_cells);
      if (length && space_.at(tiles_.middle_cell(tile)))
        ranked_.push_back({*length, static_cast<std::uint32_t>(tiles_.index(tile))});
    }
  }
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

void TurnPointChoice::rank_tiles(double longest_cells) {
  ranked_.clear();
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
    if (first_of_tile_[i] == first_of_tile_[i + 1]) continue;
    if (const std::optional<std::int32_t> length = through(tiles_.tile(i), longest_cells))
      ranked_.push_back({*length, i});
  }
}

/// No other chosen point is so near that a path could as well turn there.
bool TurnPointChoice::is_apart(const TurnPoint& point, std::uint32_t tile) const {
  const double apart = std::max(1.0, 0.5 * space_.radius_cells());  // less than a tile
  const Vec2 outwards = point.position - point.corner;
  const auto is_near = [&](const TurnPlace& there) {
    return (there.position - point.position).squaredNorm() < apart * apart &&
           outwards.dot(there.position - *there.corner) > 0.0;
  };
  const Cell at = tiles_.tile(tile);
  for (int row = std::max(at.row - 1, 0); row <= std::min(at.row + 1, tiles_.rows() - 1); ++row) {
    for (int column = std::max(at.column - 1, 0); column <= std::min(at.column + 1, tiles_.columns() - 1);
         ++column) {
      for (std::uint32_t i = newest_of_tile_[tiles_.index({column, row})]; i != none; i = older_of_tile_[i])
        if (is_near(chosen_[i])) return false;
    }
  }
  return true;
}

/// Looked at once: it is a property of the map.
bool TurnPointChoice::lets_bend(std::uint32_t index) {
  Bend& known = bends_[index];
  if (known == Bend::unknown) known = looks_bendable(turn_points_[index]) ? Bend::possible : Bend::impossible;
  return known == Bend::possible;
}

/// Whether a path can bend here by a noticeable angle around the corner. Along a ragged wall every bump is a
/// corner, but a bend around it soon runs into the next.
bool TurnPointChoice::looks_bendable(const TurnPoint& point) const {
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
