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

/// How the robot stands at the start and shall stand at the goal, where that is known or wanted. In the grid
/// frame.
struct EndHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// What a path of straight legs costs: metres of length, or seconds for a robot that turns on the spot and
/// drives from rest to rest. Where cells cost more than 1 (near obstacles), a leg costs its mean cell's share
/// more.
class PathCost {
 public:
  /// Without limits: length. `costs` may be empty: every cell costs 1. The map and the costs must outlive it.
  PathCost(const OccupancyMap& map, const CellCosts& costs, std::optional<MotionLimits> limits)
      : map_(map), costs_(costs), limits_(limits) {}

  [[nodiscard]] bool counts_turns() const { return limits_.has_value(); }
  [[nodiscard]] bool counts_cells() const { return !costs_.empty(); }

  /// The least that a leg of this many cells can cost; no chain of legs between its ends costs less.
  [[nodiscard]] double at_least(double length_cells) const {
    const double length_m = length_cells * map_.resolution_m;
    return limits_ ? limits_->leg_time_s(length_m) : length_m;
  }
  [[nodiscard]] double leg(const Vec2& from, const Vec2& to) const;
  /// Of a turn on the spot from one heading to another, both in [-pi, pi]; two turns never cost less than one
  /// from the first heading to the last.
  [[nodiscard]] double turn(double from_rad, double to_rad) const {
    if (!limits_) return 0.0;
    const double angle_rad = std::abs(to_rad - from_rad);
    return limits_->turn_time_s(std::min(angle_rad, 2.0 * std::numbers::pi - angle_rad));
  }
  [[nodiscard]] double path(std::span<const Vec2> points, const EndHeadings& headings) const;

 private:
  [[nodiscard]] bool is_on_map(const Vec2& point) const;
  [[nodiscard]] double mean_cell_cost(const Vec2& from, const Vec2& to) const;

  const OccupancyMap& map_;
  const CellCosts& costs_;
  std::optional<MotionLimits> limits_;
};

}  // namespace lodestar
