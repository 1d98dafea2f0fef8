#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "maps/travel_time.hpp"
#include "planning/collision_checker.hpp"
#include "planning/grid_search.hpp"

namespace lodestar {

/// Headings at the start and the goal in the grid frame, where known or wanted.
struct EndHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// Least relative saving for which a path is changed.
inline constexpr double worthwhile_saving = 1e-6;

/// Headings before and after the part of a path between two of its points.
EndHeadings headings_of_part(std::span<const Vec2> points, std::size_t from, std::size_t to,
                             const EndHeadings& of_path);

/// Cost of a path of straight legs: length in metres, or travel time in seconds for a robot that turns on the
/// spot and drives from rest to rest. A leg's cost is multiplied by the mean cost of its cells, above 1 near
/// obstacles.
class PathCost {
 public:
  /// Without limits: length. `costs` may be empty: every cell costs 1. The map and the costs must outlive it.
  PathCost(const OccupancyMap& map, const CellCosts& costs, std::optional<MotionLimits> limits)
      : map_(map),
        costs_(costs),
        limits_(limits),
        leg_time_(limits.value_or(MotionLimits{}).leg_time()),
        turn_time_(limits.value_or(MotionLimits{}).turn_time()) {}

  [[nodiscard]] bool counts_turns() const { return limits_.has_value(); }
  [[nodiscard]] bool counts_cells() const { return !costs_.empty(); }

  /// Lower bound on the cost of a leg of this many cells, and of any chain of legs between its ends.
  [[nodiscard]] double at_least(double length_cells) const {
    const double length_m = length_cells * map_.resolution_m;
    return limits_ ? leg_time_.of(length_m) : length_m;
  }
  /// Length in cells of the longest path that can cost no more than this.
  [[nodiscard]] double longest(double cost) const {
    const double length_m = limits_ ? limits_->max_forward_mps * cost : cost;
    return length_m / map_.resolution_m;
  }
  [[nodiscard]] double leg(const Vec2& from, const Vec2& to) const;
  /// Cost of a turn on the spot between two headings, both in [-pi, pi]. Two turns never cost less than the
  /// direct one (triangle inequality).
  [[nodiscard]] double turn(double from_rad, double to_rad) const {
    if (!limits_) return 0.0;
    const double angle_rad = std::abs(to_rad - from_rad);
    return turn_time_.of(std::min(angle_rad, 2.0 * std::numbers::pi - angle_rad));
  }
  [[nodiscard]] double path(std::span<const Vec2> points, const EndHeadings& headings) const;

 private:
  [[nodiscard]] bool is_on_map(const Vec2& point) const;
  [[nodiscard]] double mean_cell_cost(const Vec2& from, const Vec2& to) const;

  const OccupancyMap& map_;
  const CellCosts& costs_;
  std::optional<MotionLimits> limits_;
  TrapezoidTime leg_time_;
  TrapezoidTime turn_time_;
};

}  // namespace lodestar
