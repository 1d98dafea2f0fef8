#pragma once

#include <cstddef>
#include <string_view>
#include <variant>

#include "maps/distance_field.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

struct GridPlannerOptions {
  double radius_m = 0.25;  ///< of the robot's body; its disc never touches a cell that is not drivable
  double preferred_clearance_m =
      0.15;                       ///< beyond the radius, cells nearer than this to an obstacle cost more
  double clearance_weight = 1.0;  ///< how much more: up to (1 + weight) times at the very edge; 0: shortest
};

enum class PlanFailure { start_outside_map, goal_outside_map, start_occupied, goal_occupied, no_path };

/// In words for people.
std::string_view to_string(PlanFailure failure);

struct Plan {
  Path path;                 ///< few straight legs, each clear of obstacles by the radius
  std::size_t expanded = 0;  ///< grid nodes taken from the open list
};

using PlanResult = std::variant<Plan, PlanFailure>;

/// A* on the 8-connected grid (Hart, Nilsson and Raphael 1968) without cutting corners, its path then
/// shortened to few straight legs. Holds the map's clearances, so that many queries share them.
class GridPlanner {
 public:
  explicit GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {});

  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m) const;

  /// Can the robot's centre be at this point / travel this straight leg without its disc touching anything?
  [[nodiscard]] bool is_clear(const Vec2& point_m) const;
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

 private:
  OccupancyMap map_;
  DistanceField distance_;
  GridPlannerOptions options_;
};

}  // namespace lodestar
