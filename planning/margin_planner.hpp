#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planning/grid_planner.hpp"

namespace lodestar {

/// How much more than the radius a path keeps, widest first: a robot that follows a path drives a little
/// beside it, now and then on the wrong side. The last is what every place must have, as an arrival may be
/// off by it.
inline constexpr std::array default_margins_m{0.03, 0.02, 0.01};

/// Plans with the widest margin that there is room for, without going a long way round for it. Where start or
/// goal lie nearer to an obstacle than that, only the way between them and the nearest roomy place does too.
/// A goal that has not even the narrowest margin, as one that touches a wall, is replaced by the nearest
/// place that has, when that is within `goal_slack_m`: the path ends there. One query at a time.
class MarginPlanner {
 public:
  static constexpr double goal_slack_m = 0.015;
  /// A path with more margin may be longer by this share of the shortest, and by so much. Chosen by hand: a
  /// step to the side at a door post is worth its margin, another corridor is not.
  static constexpr double detour_share = 0.1;
  static constexpr double detour_m = 0.5;

  /// Outlines are planned without a margin.
  explicit MarginPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {},
                         std::span<const double> margins_m = default_margins_m);

  /// The failure is that of the narrowest margin.
  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m,
                                const PlanHeadings& headings = {}) const;

  /// With the narrowest margin.
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

  /// With the widest.
  [[nodiscard]] bool is_roomy(const Vec2& from_m, const Vec2& to_m) const {
    return at(0).is_clear(from_m, to_m);
  }

  /// As GridPlanner's, with the narrowest margin.
  [[nodiscard]] std::optional<Vec2> nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const;

 private:
  /// Made when first asked for.
  struct Level {
    double margin_m = 0.0;
    std::unique_ptr<const GridPlanner> planner;
  };

  [[nodiscard]] const GridPlanner& at(std::size_t level) const;
  [[nodiscard]] const GridPlanner& narrowest() const { return at(levels_.size() - 1); }
  [[nodiscard]] Vec2 goal_with_margin(const Vec2& goal_m) const;
  [[nodiscard]] std::optional<Vec2> roomy_place_near(const Vec2& point_m, std::size_t level) const;
  [[nodiscard]] PlanResult plan_at(std::size_t level, const Vec2& start_m, const Vec2& goal_m,
                                   const PlanHeadings& headings) const;

  OccupancyMap map_;
  GridPlannerOptions options_;
  mutable std::vector<Level> levels_;  ///< widest first
};

}  // namespace lodestar
