#include "planning/grid_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace lodestar {
namespace {

constexpr std::array<Cell, 8> steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

double octile(Cell a, Cell b) {
  const int dx = std::abs(a.column - b.column);
  const int dy = std::abs(a.row - b.row);
  return std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy);
}

struct Open {
  double total = 0.0;  ///< cost so far and the least that can follow
  double cost = 0.0;
  std::size_t index = 0;
};

/// The least total first; among equals the one that has come farther, then the lower index.
struct Later {
  bool operator()(const Open& a, const Open& b) const {
    if (a.total != b.total) return a.total > b.total;
    if (a.cost != b.cost) return a.cost < b.cost;
    return a.index > b.index;
  }
};

class Search {
 public:
  Search(const OccupancyMap& map, const ClearSpace& space, const CellCosts& costs, Cell goal)
      : map_(map),
        space_(space),
        costs_(costs),
        goal_(goal),
        best_(map.cells.size(), std::numeric_limits<double>::infinity()),
        came_by_(map.cells.size(), -1) {}

  std::optional<GridPath> run(Cell start) {
    reach(start, 0.0, -1);
    while (!open_.empty()) {
      const Open next = open_.top();
      open_.pop();
      if (next.cost > best_[next.index]) continue;  // a better way was found since
      ++expanded_;
      const Cell cell = cell_of(next.index);
      if (cell == goal_) return path_to(cell);
      expand(cell, next.cost);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Cell cell_of(std::size_t index) const {
    const auto columns = static_cast<std::size_t>(map_.columns);
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }

  void expand(Cell cell, double cost) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const Cell to{cell.column + steps[k].column, cell.row + steps[k].row};
      if (!space_.at(to)) continue;
      const bool diagonal = k >= 4;
      if (diagonal && !(space_.at({to.column, cell.row}) && space_.at({cell.column, to.row}))) continue;
      const double length = diagonal ? std::numbers::sqrt2 : 1.0;
      const double mean_cost =
          0.5 * (static_cast<double>(costs_[map_.index(cell)]) + static_cast<double>(costs_[map_.index(to)]));
      reach(to, cost + length * mean_cost, static_cast<int>(k));
    }
  }

  void reach(Cell cell, double cost, int by) {
    const std::size_t index = map_.index(cell);
    if (cost >= best_[index]) return;
    best_[index] = cost;
    came_by_[index] = static_cast<std::int8_t>(by);
    open_.push({cost + octile(cell, goal_), cost, index});
  }

  [[nodiscard]] GridPath path_to(Cell cell) const {
    GridPath path{.cells = {cell}, .cost = best_[map_.index(cell)], .expanded = expanded_};
    const auto came_by = [&](Cell at) -> std::optional<std::size_t> {
      const std::int8_t by = came_by_[map_.index(at)];
      return by < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(by));
    };
    for (auto by = came_by(cell); by; by = came_by(cell)) {
      const Cell step = steps[*by];
      cell = {cell.column - step.column, cell.row - step.row};
      path.cells.push_back(cell);
    }
    std::ranges::reverse(path.cells);
    return path;
  }

  const OccupancyMap& map_;
  const ClearSpace& space_;
  const CellCosts& costs_;
  Cell goal_;
  std::vector<double> best_;
  std::vector<std::int8_t> came_by_;
  std::priority_queue<Open, std::vector<Open>, Later> open_;
  std::size_t expanded_ = 0;
};

}  // namespace

std::optional<GridPath> search_grid(const OccupancyMap& map, const ClearSpace& space, const CellCosts& costs,
                                    Cell start, Cell goal) {
  if (!space.at(start) || !space.at(goal) || space.region(start) != space.region(goal)) return std::nullopt;
  return Search(map, space, costs, goal).run(start);
}

}  // namespace lodestar
