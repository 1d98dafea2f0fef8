#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "maps/distance_field.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

struct GridPlannerOptions {
  double radius_m = 0.25;  ///< of the robot's body; its disc never overlaps a cell that is not drivable
  double preferred_clearance_m =
      0.15;                       ///< beyond the radius, cells nearer than this to an obstacle cost more
  double clearance_weight = 1.0;  ///< how much more: up to (1 + weight) times at the very edge; 0: shortest
  double turn_cost_m = 0.2;       ///< the way that a turn is worth to a robot that stops to rotate
};

enum class PlanFailure { start_outside_map, goal_outside_map, start_occupied, goal_occupied, no_path };

/// In words for people.
std::string_view to_string(PlanFailure failure);

struct Plan {
  Path path;                 ///< few straight legs, each clear of obstacles by the radius
  std::size_t expanded = 0;  ///< grid cells taken from the open list
};

using PlanResult = std::variant<Plan, PlanFailure>;

class ClearSpace;

/// A* on the 8-connected grid without cutting corners, its path then shortened to few straight legs. Holds
/// what it knows of the map, so that many queries share it.
class GridPlanner {
 public:
  explicit GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {});
  ~GridPlanner();
  GridPlanner(const GridPlanner&) = delete;
  GridPlanner& operator=(const GridPlanner&) = delete;

  /// A robot that stands nearer to an obstacle than its radius, as a pose a centimetre off may say, is led
  /// out on the shortest way; the goal must be clear.
  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m) const;

  /// Can the robot's centre travel this straight leg without its disc overlapping anything?
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

 private:
  [[nodiscard]] Vec2 in_grid(const Vec2& point_m) const;
  [[nodiscard]] Vec2 in_map(const Vec2& point_in_grid) const;
  [[nodiscard]] std::optional<Cell> clear_cell_near(const Vec2& point_in_grid) const;
  [[nodiscard]] std::optional<Cell> way_out(const Vec2& start_in_grid) const;
  void weigh_cells();

  OccupancyMap map_;
  GridPlannerOptions options_;
  std::unique_ptr<ClearSpace> space_;
  std::vector<float> costs_;
};

}  // namespace lodestar
