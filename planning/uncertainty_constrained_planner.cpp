#include "planning/uncertainty_constrained_planner.hpp"

#include <algorithm>
#include <cmath>

#include "planning/grid_step.hpp"
#include "planning/path_cost.hpp"
#include "planning/path_shortening.hpp"

namespace lodestar {
/// A Pareto label: a path to a place that no other path to it dominates in both cost and sigma.
struct UncertaintyConstrainedPlanner::Label {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t place = 0;
  double cost = 0.0;
  double sigma_m = 0.0;
  std::size_t parent = none;
  bool beaten = false;

  [[nodiscard]] bool beats(double other_cost, double other_sigma_m) const {
    return cost <= other_cost && sigma_m <= other_sigma_m;
  }
};

UncertaintyConstrainedPlanner::UncertaintyConstrainedPlanner(const CollisionChecker& space,
                                                             const CellCosts& costs,
                                                             UncertaintyConstraint constraint)
    : space_(space), costs_(costs), constraint_(std::move(constraint)) {}

double UncertaintyConstrainedPlanner::after_step(double sigma_m, double length_cells, Cell to) const {
  const OccupancyMap& map = space_.map();
  if (!map.contains(to)) return std::numeric_limits<double>::infinity();
  const double drifted_m = sigma_m + constraint_.drift_m_per_m * length_cells * map.resolution_m;
  return std::min(drifted_m, static_cast<double>(constraint_.fix_sigma_m[map.index(to)]));
}

std::optional<double> UncertaintyConstrainedPlanner::along(double sigma_m, const Vec2& from,
                                                           const Vec2& to) const {
  const double length = (to - from).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * length)));
  for (int i = 1; i <= steps; ++i) {
    const Vec2 at = from + (to - from) * (static_cast<double>(i) / steps);
    const Cell cell = cell_at(at);
    sigma_m = after_step(sigma_m, length / steps, cell);
    if (sigma_m > constraint_.limit_m) return std::nullopt;
  }
  return sigma_m;
}

bool UncertaintyConstrainedPlanner::holds(std::span<const Vec2> points) const {
  std::optional<double> sigma_m = along(constraint_.at_start_m, points.front(), points.front());
  for (std::size_t i = 1; i < points.size() && sigma_m; ++i) {
    sigma_m = along(*sigma_m, points[i - 1], points[i]);
  }
  return sigma_m.has_value();
}

/// One query.
class UncertaintyConstrainedPlanner::Search {
 public:
  Search(const UncertaintyConstrainedPlanner& way, Cell last, const Vec2& goal)
      : way_(way), map_(way.space_.map()), last_(last), goal_(goal), labels_at_(map_.cells.size()) {}

  std::optional<GridPath> run(Cell first, double sigma_m) {
    reach(first, 0.0, sigma_m, Label::none);
    std::size_t expanded = 0;
    while (!open_.empty()) {
      const std::size_t label = open_.front().label;
      std::ranges::pop_heap(open_, later);
      open_.pop_back();
      if (labels_[label].beaten) continue;
      ++expanded;
      const Cell cell = cell_of(labels_[label].place);
      if (cell == last_ && way_.along(labels_[label].sigma_m, center_of(cell), goal_)) {
        return GridPath{cells_to(label), labels_[label].cost, expanded};
      }
      expand(label);
    }
    return std::nullopt;
  }

 private:
  struct Open {
    double total = 0.0;
    std::size_t label = 0;
  };
  /// Least total first; among equals the older label.
  static bool later(const Open& a, const Open& b) {
    return a.total != b.total ? a.total > b.total : a.label > b.label;
  }

  [[nodiscard]] Cell cell_of(std::size_t place) const {
    const auto columns = static_cast<std::size_t>(map_.columns);
    return {static_cast<int>(place % columns), static_cast<int>(place / columns)};
  }
  [[nodiscard]] double cost_of(Cell cell) const {
    return way_.costs_.empty() ? 1.0 : static_cast<double>(way_.costs_[map_.index(cell)]);
  }

  void expand(std::size_t label) {
    const Label from = labels_[label];
    const Cell cell = cell_of(from.place);
    const CollisionChecker& space = way_.space_;
    for (int k = 0; k < 8; ++k) {
      const Cell step = grid_steps[static_cast<std::size_t>(k)];
      const Cell to{cell.column + step.column, cell.row + step.row};
      if (!space.at(to)) continue;
      if (is_diagonal(k) && !(space.at({to.column, cell.row}) && space.at({cell.column, to.row}))) continue;
      const std::optional<double> sigma_m = way_.along(from.sigma_m, center_of(cell), center_of(to));
      if (!sigma_m) continue;
      const double length = is_diagonal(k) ? std::numbers::sqrt2 : 1.0;
      reach(to, from.cost + length * 0.5 * (cost_of(cell) + cost_of(to)), *sigma_m, label);
    }
  }

  void reach(Cell cell, double cost, double sigma_m, std::size_t parent) {
    const std::size_t place = map_.index(cell);
    std::vector<std::size_t>& here = labels_at_[place];
    if (std::ranges::any_of(here, [&](std::size_t i) { return labels_[i].beats(cost, sigma_m); })) return;
    std::erase_if(here, [&](std::size_t i) {
      const bool beaten = cost <= labels_[i].cost && sigma_m <= labels_[i].sigma_m;
      labels_[i].beaten = labels_[i].beaten || beaten;
      return beaten;
    });
    here.push_back(labels_.size());
    open_.push_back({cost + free_steps(cell, last_).length_cells(), labels_.size()});
    std::ranges::push_heap(open_, later);
    labels_.push_back({.place = place, .cost = cost, .sigma_m = sigma_m, .parent = parent});
  }

  [[nodiscard]] std::vector<Cell> cells_to(std::size_t label) const {
    std::vector<Cell> cells;
    for (; label != Label::none; label = labels_[label].parent)
      cells.push_back(cell_of(labels_[label].place));
    std::ranges::reverse(cells);
    return cells;
  }

  const UncertaintyConstrainedPlanner& way_;
  const OccupancyMap& map_;
  Cell last_;
  Vec2 goal_;
  std::vector<std::vector<std::size_t>> labels_at_;
  std::vector<Label> labels_;
  std::vector<Open> open_;
};

std::optional<GridPath> UncertaintyConstrainedPlanner::find(const Vec2& start, Cell first, Cell last,
                                                            const Vec2& goal) const {
  const std::optional<double> at_start_m = along(constraint_.at_start_m, start, start);
  const std::optional<double> sigma_m =
      at_start_m ? along(*at_start_m, start, center_of(first)) : std::nullopt;
  if (!sigma_m) return std::nullopt;
  return Search(*this, last, goal).run(first, *sigma_m);
}

std::vector<Vec2> UncertaintyConstrainedPlanner::shortened(const std::vector<Vec2>& points,
                                                           double turn_cost_m) const {
  if (points.size() < 3) return points;
  const PathCost cost(space_.map(), costs_, std::nullopt);
  const std::vector<Vec2> at = leg_ends(points);
  std::vector<Label> labels{{.sigma_m = along(constraint_.at_start_m, at[0], at[0]).value()}};
  std::vector<std::vector<std::size_t>> labels_at(at.size());
  labels_at[0].push_back(0);
  for (std::size_t to = 1; to < at.size(); ++to) {
    for (std::size_t from = 0; from < to; ++from) {
      if (from + 1 < to && !space_.along(at[from], at[to])) continue;
      const double leg = cost.leg(at[from], at[to]) + (from == 0 ? 0.0 : turn_cost_m);
      for (const std::size_t parent : labels_at[from]) {
        const std::optional<double> sigma_m = along(labels[parent].sigma_m, at[from], at[to]);
        if (!sigma_m) continue;
        const double total = labels[parent].cost + leg;
        if (std::ranges::any_of(labels_at[to],
                                [&](std::size_t i) { return labels[i].beats(total, *sigma_m); }))
          continue;
        labels_at[to].push_back(labels.size());
        labels.push_back({.place = to, .cost = total, .sigma_m = *sigma_m, .parent = parent});
      }
    }
  }
  std::vector<Vec2> legs;
  std::size_t label =
      *std::ranges::min_element(labels_at.back(), {}, [&](std::size_t i) { return labels[i].cost; });
  for (; label != Label::none; label = labels[label].parent) legs.push_back(at[labels[label].place]);
  std::ranges::reverse(legs);
  return legs;
}

}  // namespace lodestar
