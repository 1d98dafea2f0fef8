#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

/// The cells in square tiles, with the steps between neighbouring tiles that a pair of cells allows which are
/// clear in part. What a clear path connects is connected in tiles. The converse holds for walls, as a tile's
/// diagonal is at most the width that a wall blocks; a gap too narrow by up to 1.4 cells may seem open.
class TileMap {
 public:
  explicit TileMap(const CollisionChecker& space);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int side_cells() const { return side_; }
  [[nodiscard]] std::size_t index(Cell tile) const {
    return static_cast<std::size_t>(tile.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(tile.column);
  }
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  /// The tile of a point in grid coordinates, which must be on the map.
  [[nodiscard]] Cell tile_at(const Vec2& point) const {
    return {static_cast<int>(point.x()) / side_, static_cast<int>(point.y()) / side_};
  }
  [[nodiscard]] Cell tile(std::size_t index) const {
    const auto columns = static_cast<std::size_t>(columns_);
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }
  [[nodiscard]] Cell middle_cell(Cell tile) const {
    return {tile.column * side_ + side_ / 2, tile.row * side_ + side_ / 2};
  }
  /// Bit k for the neighbour in direction grid_steps[k], k even.
  [[nodiscard]] std::uint8_t steps(std::size_t tile) const { return steps_[tile]; }

 private:
  void join_rows(const CollisionChecker& space);
  void join_columns(const CollisionChecker& space);

  int side_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint8_t> steps_;
};

/// Lengths of the shortest paths from one point, over tiles: Dijkstra with the chamfer weights 5 and 7. Up to
/// a tenth longer than the straight line on open ground. Memory is kept between searches.
class TileDistances {
 public:
  explicit TileDistances(const TileMap& tiles) : tiles_(tiles), reached_(tiles.size()) {}

  /// Measures from a clear cell, up to a length in cells; over at most `most_tiles`, the nearest ones. With
  /// `other`, only tiles on paths between the two points that are no longer than that.
  void measure(Cell from, double up_to_cells, std::size_t most_tiles, const TileDistances* other = nullptr);

  /// Length in cells to a tile's middle; nothing for a tile that was not reached.
  [[nodiscard]] std::optional<double> at(Cell tile) const {
    const Reached& reached = reached_[tiles_.index(tile)];
    if (reached.visit != visit_) return std::nullopt;
    return cells_a_unit() * reached.length;
  }
  [[nodiscard]] std::size_t expanded() const { return expanded_; }

 private:
  struct Reached {
    std::uint32_t visit = 0;
    std::int32_t length = 0;  ///< in fifths of a tile's side
  };
  static constexpr std::int32_t straight = 5;
  static constexpr std::int32_t diagonal = 7;

  [[nodiscard]] double cells_a_unit() const { return static_cast<double>(tiles_.side_cells()) / straight; }
  void reach(std::size_t tile, std::int32_t length);
  void expand(std::size_t tile, std::int32_t length);

  const TileMap& tiles_;
  std::vector<Reached> reached_;
  std::array<std::vector<std::uint32_t>, 8> buckets_;  ///< by length modulo 8
  std::uint32_t visit_ = 0;
  std::size_t expanded_ = 0;
  std::size_t waiting_ = 0;
};

}  // namespace lodestar
