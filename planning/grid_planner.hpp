#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/travel_time.hpp"
#include "planning/footprint.hpp"
#include "planning/planner_kind.hpp"
#include "planning/uncertainty_constrained_planner.hpp"

namespace lodestar {

class FootprintPlanner;

/// Ground to keep away from where there is another way: it costs as much as if it were longer.
struct AvoidedArea {
  std::vector<Vec2> places_m;  ///< in the map frame
  double within_m = 1.0;       ///< cells nearer than this to one of them
  double weight = 10.0;        ///< cost (1 + weight) times as much
};

struct GridPlannerOptions {
  PlannerKind kind = PlannerKind::astar;
  double radius_m = 0.25;  ///< of the robot's body; its disc never overlaps a cell that is not drivable
  std::optional<Footprint> footprint;  ///< when given, planned for instead of the disc
  double preferred_clearance_m =
      0.15;                       ///< beyond the radius, cells nearer than this to an obstacle cost more
  double clearance_weight = 1.0;  ///< how much more: up to (1 + weight) times at the very edge; 0: shortest
  AvoidedArea avoided;            ///< not by a footprint
  double turn_cost_m = 0.2;  ///< of `astar`: the way that a turn is worth to a robot that stops to rotate
  MotionLimits limits;       ///< of `fastest`
  SamplingOptions sampling;  ///< of the planners of OMPL
  /// When given, a path on which the robot would grow less sure of its position than this allows is not
  /// taken: then the shortest 8-connected one that keeps to it, shortened as far as it still does.
  std::optional<UncertaintyConstraint> uncertainty_constraint;
};

enum class PlanFailure {
  start_outside_map,
  goal_outside_map,
  start_occupied,
  goal_occupied,
  no_path,       ///< there is none
  unsure,        ///< there are some, but on each the pose grows less sure than UncertaintyConstraint allows
  limit_reached  ///< a sampling planner found none within its limits, though there is one
};

/// In words for people.
std::string_view to_string(PlanFailure failure);

struct Plan {
  Path path;                 ///< few straight legs, each clear of obstacles by the radius
  std::size_t expanded = 0;  ///< grid cells and turn points taken from open lists, or iterations
};

using PlanResult = std::variant<Plan, PlanFailure>;

/// How the robot stands at the start and shall stand at the goal, in the map frame; `fastest` counts those
/// turns.
struct PlanHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// Plans over an occupancy map. Holds what it knows of the map and the searches' memory, so that many queries
/// share it; one query at a time.
class GridPlanner {
 public:
  explicit GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {});
  ~GridPlanner();
  GridPlanner(const GridPlanner&) = delete;
  GridPlanner& operator=(const GridPlanner&) = delete;

  /// A robot that stands nearer to an obstacle than its radius, as a pose a centimetre off may say, is led
  /// out on the shortest way; the goal must be clear.
  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m,
                                const PlanHeadings& headings = {}) const;

  /// Can the robot's centre travel this straight leg without its disc, or outline, overlapping anything?
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

  /// The place nearest to a goal, a cell's centre, that can be reached from the start; nothing when the robot
  /// cannot leave the start. To be offered to people: no plan goes there unasked.
  [[nodiscard]] std::optional<Vec2> nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const;

 private:
  struct Searches;
  /// Start and goal in grid coordinates, and the clear cells from which and to which the grid is searched.
  struct Ends {
    Vec2 start;
    Vec2 goal;
    Cell first;
    Cell last;
    bool starts_clear = true;
  };

  [[nodiscard]] Vec2 in_grid(const Vec2& point_m) const;
  [[nodiscard]] Vec2 in_map(const Vec2& point_in_grid) const;
  [[nodiscard]] std::variant<Ends, PlanFailure> ends_of(const Vec2& start_m, const Vec2& goal_m) const;
  [[nodiscard]] std::optional<Cell> first_cell(const Vec2& start) const;
  [[nodiscard]] std::optional<Cell> clear_cell_near(const Vec2& point_in_grid) const;
  [[nodiscard]] std::optional<Cell> way_out(const Vec2& start_in_grid) const;
  [[nodiscard]] std::optional<std::vector<Vec2>> legs_between(const Ends& ends, const PlanHeadings& headings,
                                                              std::size_t& expanded) const;
  [[nodiscard]] std::optional<std::vector<Vec2>> legs_within_constraint(const Ends& ends,
                                                                        std::size_t& expanded) const;
  [[nodiscard]] std::vector<Vec2> few_legs(const Ends& ends, std::size_t& expanded) const;
  [[nodiscard]] std::vector<Vec2> cheapest_legs(const Ends& ends, const PlanHeadings& headings,
                                                std::size_t& expanded) const;
  [[nodiscard]] std::optional<std::vector<Vec2>> sampled_legs(const Ends& ends, std::size_t& expanded) const;
  [[nodiscard]] static std::vector<Vec2> points_over(std::span<const Cell> cells, const Ends& ends);
  [[nodiscard]] std::vector<Vec2> jump_path(const Ends& ends, std::size_t& expanded) const;
  void weigh_cells();
  void weigh_near_obstacles();
  void weigh_avoided();
  void prepare_searches();

  OccupancyMap map_;
  GridPlannerOptions options_;
  std::vector<float> costs_;  ///< of cells; empty: all alike
  std::unique_ptr<Searches> searches_;
  std::unique_ptr<FootprintPlanner> outline_;  ///< answers instead when there is an outline
};

}  // namespace lodestar
