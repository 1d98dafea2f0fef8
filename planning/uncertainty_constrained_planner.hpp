#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/grid_search.hpp"

namespace lodestar {

/// How sure of its position a robot can be in each cell of a map, and how sure it must stay all the way.
struct UncertaintyConstraint {
  /// Standard deviation of a fix at the worst heading, row by row as the map's cells; infinity where some
  /// heading sees nothing.
  std::vector<float> fix_sigma_m;
  double drift_m_per_m = 0.03;  ///< by so much the deviation grows on the way from one fix to the next
  double limit_m = 0.05;        ///< that it may never pass
  double at_start_m = 0.0;      ///< the deviation with which the robot sets out
};

/// Paths on which the predicted deviation of the position stays below a limit: on the way it grows with the
/// distance driven, and where a fix would be better the fix counts. Points in grid coordinates. Space and
/// costs must outlive it.
class UncertaintyConstrainedPlanner {
 public:
  /// `costs` may be empty: every cell costs 1.
  UncertaintyConstrainedPlanner(const CollisionChecker& space, const CellCosts& costs,
                                UncertaintyConstraint constraint);

  /// The deviation at the end of a leg that is entered with `sigma_m`, looked at twice a cell; nothing when
  /// it passes the limit on the way.
  [[nodiscard]] std::optional<double> along(double sigma_m, const Vec2& from, const Vec2& to) const;

  /// Does the deviation stay below the limit on all of a path?
  [[nodiscard]] bool holds(std::span<const Vec2> points) const;

  /// The cheapest 8-connected way from `start` by way of cells from `first` to `last` to `goal` on which it
  /// does; nothing when there is none. A* over cells with the deviation as a resource: of the ways to a cell
  /// those are kept than which no other is both cheaper and surer (Martins 1984).
  [[nodiscard]] std::optional<GridPath> find(const Vec2& start, Cell first, Cell last,
                                             const Vec2& goal) const;

  /// Few straight clear legs over the given points that keep to the limit as well, the cheapest such chain; a
  /// turn costs as much as `turn_cost_m` of way. The points themselves must keep to it.
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
