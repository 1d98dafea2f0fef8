#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/grid_search.hpp"

namespace lodestar {

/// The position sigma available in each cell of a map, and the limit to keep on the whole path.
struct UncertaintyConstraint {
  /// Standard deviation of a fix at the worst heading, row by row as the map's cells; infinity where some
  /// heading sees no marker.
  std::vector<float> fix_sigma_m;
  double drift_m_per_m = 0.03;  ///< growth of sigma with the distance driven between fixes
  double limit_m = 0.05;        ///< greatest sigma allowed
  double at_start_m = 0.0;      ///< sigma at the start
};

/// Plans paths on which the predicted position sigma stays within a limit: it grows with the distance driven,
/// and drops to a cell's fix sigma where that is smaller. Points in grid coordinates. Space and costs must
/// outlive it.
class UncertaintyConstrainedPlanner {
 public:
  /// `costs` may be empty: every cell costs 1.
  UncertaintyConstrainedPlanner(const CollisionChecker& space, const CellCosts& costs,
                                UncertaintyConstraint constraint);

  /// Sigma at the end of a leg entered with `sigma_m`, evaluated every half cell; nothing when it exceeds the
  /// limit on the leg.
  [[nodiscard]] std::optional<double> along(double sigma_m, const Vec2& from, const Vec2& to) const;

  /// Does sigma stay within the limit on the whole path?
  [[nodiscard]] bool holds(std::span<const Vec2> points) const;

  /// The cheapest 8-connected path from `start` through cells `first` to `last` to `goal` on which it does;
  /// nothing when there is none. A* over labels (cost, sigma): each cell keeps its Pareto-optimal labels, by
  /// dominance (Martins 1984).
  [[nodiscard]] std::optional<GridPath> find(const Vec2& start, Cell first, Cell last,
                                             const Vec2& goal) const;

  /// The cheapest chain of straight clear legs over the given points that keeps the limit; a turn costs as
  /// much as `turn_cost_m` of length. The given points themselves must keep the limit.
  [[nodiscard]] std::vector<Vec2> shortened(const std::vector<Vec2>& points, double turn_cost_m) const;

 private:
  struct Label;
  class Search;

  [[nodiscard]] double after_step(double sigma_m, double length_cells, Cell to) const;

  const CollisionChecker& space_;
  const CellCosts& costs_;
  UncertaintyConstraint constraint_;
};

}  // namespace lodestar
