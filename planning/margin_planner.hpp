#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planning/grid_planner.hpp"

namespace lodestar {

/// Safety margins beyond the radius, widest first, as the robot follows a path with some cross-track error.
/// Every path must keep the last one, as an arrival may be off by it.
inline constexpr std::array default_margins_m{0.03, 0.02, 0.01};

/// Plans with the widest margin possible without a long detour. When start or goal have less, only the legs
/// between them and the nearest place with that margin keep the narrowest. A goal without even the narrowest
/// margin, as one that touches a wall, is replaced by the nearest position that has it, when that is within
/// GridPlannerOptions::goal_slack_m: the path ends there. One query at a time.
class MarginPlanner {
 public:
  /// A path with more margin may be longer than the shortest by detour_share of it plus detour_m. Chosen by
  /// hand: a step aside at a door post is worth its margin, another corridor is not.
  static constexpr double detour_share = 0.1;
  static constexpr double detour_m = 0.5;

  /// Footprints are planned without a margin.
  explicit MarginPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {},
                         std::span<const double> margins_m = default_margins_m);
  /// Shares the field with others on the same map.
  explicit MarginPlanner(std::shared_ptr<const ObstacleField> field, const GridPlannerOptions& options = {},
                         std::span<const double> margins_m = default_margins_m);

  /// A failure is that with the narrowest margin.
  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m,
                                const PlanHeadings& headings = {}) const;

  /// Is a leg clear with the narrowest margin?
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

  /// Is a leg clear with the widest?
  [[nodiscard]] bool is_roomy(const Vec2& from_m, const Vec2& to_m) const {
    return at(0).is_clear(from_m, to_m);
  }

  /// As GridPlanner::nearest_reachable(), with the narrowest margin.
  [[nodiscard]] std::optional<Vec2> nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const;

 private:
  /// The planner is created at first use.
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

  std::shared_ptr<const ObstacleField> field_;  ///< of all levels
  const OccupancyMap& map_;
  GridPlannerOptions options_;
  mutable std::vector<Level> levels_;  ///< widest first
};

}  // namespace lodestar
