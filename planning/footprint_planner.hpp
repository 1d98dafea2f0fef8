#pragma once

#include "planning/footprint_search.hpp"
#include "planning/grid_planner.hpp"

namespace lodestar {

/// Plans for a robot with a footprint. First the paths of two discs are tried. The inscribed disc's path is
/// taken when the footprint is clear along it: as no footprint needs less room, it is the best that the
/// planner finds. The circumscribed disc's path is taken when at most 2 % slower; the footprint is clear
/// along it, except perhaps on the first leg out of a tight start, which is checked. Else FootprintSearch
/// plans in SE(2).
class FootprintPlanner {
 public:
  /// The map must outlive it.
  FootprintPlanner(const OccupancyMap& map, const Footprint& footprint, const GridPlannerOptions& options);

  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m, const PlanHeadings& headings) const;
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;
  [[nodiscard]] std::optional<Vec2> nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const;

 private:
  /// A query in grid coordinates and in the map frame.
  struct Query;

  [[nodiscard]] std::optional<PlanFailure> fits_at_ends(const Query& query) const;
  [[nodiscard]] std::optional<Plan> fitting(const PlanResult& result, const Query& query) const;
  [[nodiscard]] PlanResult searched(const Query& query) const;
  [[nodiscard]] PlanResult sampled(const Query& query) const;
  [[nodiscard]] PlanResult plan_over(std::vector<Vec2> points, std::size_t expanded,
                                     const Query& query) const;
  [[nodiscard]] double time_s(const Plan& plan, const Query& query) const;

  const OccupancyMap& map_;
  GridPlannerOptions options_;
  FootprintCollisionChecker space_;
  GridPlanner inner_;
  GridPlanner outer_;
  std::unique_ptr<FootprintSearch> search_;
  CellCosts even_;
  std::optional<UncertaintyConstrainedPlanner> constrained_;
};

}  // namespace lodestar
