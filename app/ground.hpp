#pragma once

#include "control/drive_options.hpp"
#include "control/free_way.hpp"
#include "planning/margin_planner.hpp"

namespace lodestar {

/// What a robot plans and drives on. Made anew for every map.
struct Ground {
  Ground(const OccupancyMap& known, const GridPlannerOptions& options);

  /// For a path over this ground: corners are cut only where there is room for it.
  [[nodiscard]] DriveOptions drive_options(const Path& path, DriveOptions options) const;

  OccupancyMap map;
  MarginPlanner planner;
  FreeWay free_way;
};

/// A robot unsure of its place keeps a little more to the middle.
PlanResult plan_for_a_lost_robot(const OccupancyMap& map, const GridPlannerOptions& options,
                                 const Vec2& start_m, const Vec2& goal_m);

}  // namespace lodestar
