#include "planning/grid_search.hpp"

#include <algorithm>

#include "planning/grid_step.hpp"

namespace lodestar {

/// Least total first; among equals the greater cost so far, then the lower index.
struct GridSearch::Later {
  bool operator()(const Open& a, const Open& b) const {
    if (a.total != b.total) return a.total > b.total;
    if (a.cost != b.cost) return a.cost < b.cost;
    return a.index > b.index;
  }
};

GridSearch::GridSearch(const CollisionChecker& space, const CellCosts& costs)
    : space_(space), costs_(costs), nodes_(costs.size()) {}

std::size_t GridSearch::index(Cell cell) const {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(space_.columns()) +
         static_cast<std::size_t>(cell.column);
}

Cell GridSearch::cell_at(std::size_t index) const {
  const auto columns = static_cast<std::size_t>(space_.columns());
  return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
}

std::optional<GridPath> GridSearch::find(Cell start, Cell goal, std::size_t most_expanded) {
  begin();
  if (!space_.at(start) || !space_.at(goal) || space_.region(start) != space_.region(goal))
    return std::nullopt;
  reach(start, 0.0, -1, goal);
  while (!open_.empty() && expanded_ < most_expanded) {
    const Open next = open_.front();
    std::ranges::pop_heap(open_, Later{});
    open_.pop_back();
    if (next.cost > nodes_[next.index].cost) continue;  // stale: a cheaper path was found since
    ++expanded_;
    const Cell cell = cell_at(next.index);
    if (cell == goal) return path_to(cell);
    expand(cell, goal);
  }
  return std::nullopt;
}

void GridSearch::begin() {
  expanded_ = 0;
  open_.clear();
  if (++visit_ != 0) return;
  std::ranges::fill(nodes_, Node{});  // the search number wrapped around
  visit_ = 1;
}

void GridSearch::expand(Cell cell, Cell goal) {
  const std::size_t from = index(cell);
  const double so_far = nodes_[from].cost;
  for (int k = 0; k < 8; ++k) {
    const Cell step = grid_steps[static_cast<std::size_t>(k)];
    const Cell to{cell.column + step.column, cell.row + step.row};
    if (!space_.at(to)) continue;
    if (is_diagonal(k) && !(space_.at({to.column, cell.row}) && space_.at({cell.column, to.row}))) continue;
    const double length = is_diagonal(k) ? std::numbers::sqrt2 : 1.0;
    const double mean_cost =
        0.5 * (static_cast<double>(costs_[from]) + static_cast<double>(costs_[index(to)]));
    reach(to, so_far + length * mean_cost, k, goal);
  }
}

void GridSearch::reach(Cell cell, double cost, int by, Cell goal) {
  const std::size_t at = index(cell);
  Node& node = nodes_[at];
  if (node.visit == visit_ && cost >= node.cost) return;
  node = {.cost = cost, .visit = visit_, .came_by = by};
  open_.push_back({cost + free_steps(cell, goal).length_cells(), cost, at});
  std::ranges::push_heap(open_, Later{});
}

GridPath GridSearch::path_to(Cell cell) const {
  GridPath path{.cells = {cell}, .cost = nodes_[index(cell)].cost, .expanded = expanded_};
  for (int by = nodes_[index(cell)].came_by; by >= 0; by = nodes_[index(cell)].came_by) {
    const Cell step = grid_steps[static_cast<std::size_t>(by)];
    cell = {cell.column - step.column, cell.row - step.row};
    path.cells.push_back(cell);
  }
  std::ranges::reverse(path.cells);
  return path;
}

}  // namespace lodestar
