#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "planning/collision_checker.hpp"

namespace lodestar {

/// Cost of each cell per unit of length, at least 1; row by row, as the map's cells.
using CellCosts = std::vector<float>;

struct GridPath {
  std::vector<Cell> cells;   ///< from start to goal, each a neighbour of the one before
  double cost = 0.0;         ///< in cells: length times mean cost of each step's two cells
  std::size_t expanded = 0;  ///< cells taken from the open list
};

/// The cheapest path on the 8-connected grid of clear cells without cutting corners, for any cell costs: A*
/// with a binary heap and the octile distance as heuristic (Hart, Nilsson and Raphael 1968). Deterministic.
/// Memory is kept between searches. Space and costs must outlive it.
class GridSearch {
 public:
  GridSearch(const CollisionChecker& space, const CellCosts& costs);

  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  /// Nothing when there is no path, or none within so many expanded cells.
  std::optional<GridPath> find(Cell start, Cell goal, std::size_t most_expanded = unlimited);

  [[nodiscard]] std::size_t expanded() const { return expanded_; }  ///< in the last search

 private:
  struct Node {
    double cost = 0.0;
    std::uint32_t visit = 0;  ///< number of the search that reached it last
    int came_by = -1;         ///< direction of the last step
  };
  struct Open {
    double total = 0.0;  ///< cost so far plus heuristic
    double cost = 0.0;
    std::size_t index = 0;
  };
  struct Later;

  [[nodiscard]] std::size_t index(Cell cell) const;
  [[nodiscard]] Cell cell_at(std::size_t index) const;
  void begin();
  void expand(Cell cell, Cell goal);
  void reach(Cell cell, double cost, int by, Cell goal);
  [[nodiscard]] GridPath path_to(Cell cell) const;

  const CollisionChecker& space_;
  const CellCosts& costs_;
  std::uint32_t visit_ = 0;
  std::size_t expanded_ = 0;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
};

}  // namespace lodestar
