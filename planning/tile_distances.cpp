#include "planning/tile_distances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "planning/grid_step.hpp"

namespace lodestar {

TileMap::TileMap(const CollisionChecker& space)
    : side_(std::max(1, static_cast<int>(std::numbers::sqrt2 * space.radius_cells()))),
      columns_((space.columns() + side_ - 1) / side_),
      rows_((space.rows() + side_ - 1) / side_),
      steps_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {
  join_rows(space);
  join_columns(space);
}

void TileMap::join_rows(const CollisionChecker& space) {
  for (int row = 0; row < space.rows(); ++row) {
    for (int tile = 0; tile + 1 < columns_; ++tile) {
      const int border = (tile + 1) * side_;
      if (!space.is_in_part_clear({border - 1, row}) || !space.is_in_part_clear({border, row})) continue;
      const std::size_t left = index({tile, row / side_});
      steps_[left] |= 1U << 0U;
      steps_[left + 1] |= 1U << 4U;
    }
  }
}

void TileMap::join_columns(const CollisionChecker& space) {
  for (int tile = 0; tile + 1 < rows_; ++tile) {
    const int border = (tile + 1) * side_;
    for (int column = 0; column < space.columns(); ++column) {
      if (!space.is_in_part_clear({column, border - 1}) || !space.is_in_part_clear({column, border}))
        continue;
      steps_[index({column / side_, tile})] |= 1U << 2U;
      steps_[index({column / side_, tile + 1})] |= 1U << 6U;
    }
  }
}

void TileDistances::measure(Cell from, double up_to_cells, std::size_t most_tiles,
                            const TileDistances* other) {
  if (++visit_ == 0) {  // wrapped around
    std::ranges::fill(reached_, Reached{});
    visit_ = 1;
  }
  for (auto& bucket : buckets_) bucket.clear();
  expanded_ = waiting_ = 0;
  const double most_units = std::min(up_to_cells / cells_a_unit(), 2e9);
  const auto most = static_cast<std::int32_t>(most_units);
  reach(tiles_.index(tiles_.tile_at(center_of(from))), 0);
  for (std::int32_t length = 0; waiting_ > 0 && length <= most; ++length) {
    std::vector<std::uint32_t>& bucket = buckets_[static_cast<std::size_t>(length) % buckets_.size()];
    for (const std::uint32_t tile : bucket) {
      --waiting_;
      if (reached_[tile].length != length || expanded_ >= most_tiles) continue;
      if (other != nullptr) {
        const Reached& there = other->reached_[tile];
        if (there.visit != other->visit_ || length + there.length > most) continue;
      }
      ++expanded_;
      expand(tile, length);
    }
    bucket.clear();
  }
}

void TileDistances::reach(std::size_t tile, std::int32_t length) {
  Reached& reached = reached_[tile];
  if (reached.visit == visit_ && reached.length <= length) return;
  reached = {visit_, length};
  buckets_[static_cast<std::size_t>(length) % buckets_.size()].push_back(static_cast<std::uint32_t>(tile));
  ++waiting_;
}

/// A diagonal step needs one way around its corner in two straight ones.
void TileDistances::expand(std::size_t tile, std::int32_t length) {
  const unsigned steps = tiles_.steps(tile);
  const auto columns = static_cast<std::ptrdiff_t>(tiles_.columns());
  const auto beside = [&](int direction) {
    const Cell step = grid_steps[static_cast<std::size_t>(direction)];
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(tile) + step.row * columns + step.column);
  };
  const auto leads = [](unsigned from, int direction) {
    return ((from >> static_cast<unsigned>(direction)) & 1U) != 0;
  };
  for (int direction = 0; direction < 8; direction += 2) {
    if (!leads(steps, direction)) continue;
    const std::size_t next = beside(direction);
    reach(next, length + straight);
    for (const int side : {2, -2}) {
      const int across = turned(direction, side);
      if (leads(tiles_.steps(next), across)) reach(beside(turned(direction, side / 2)), length + diagonal);
    }
  }
}

}  // namespace lodestar
