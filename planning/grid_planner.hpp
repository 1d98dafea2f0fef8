#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "maps/footprint.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/travel_time.hpp"
#include "planning/planner_kind.hpp"
#include "planning/turn_search_limits.hpp"
#include "planning/uncertainty_constrained_planner.hpp"

namespace lodestar {

class FootprintPlanner;
class PathCost;
struct EndHeadings;
struct TurnPath;

/// Area to avoid when there is another path: its cells cost more.
struct AvoidedArea {
  std::vector<Vec2> places_m;  ///< in the map frame
  double within_m = 1.0;       ///< cells within this distance of a place
  double weight = 10.0;        ///< cost (1 + weight) times as much
};

struct GridPlannerOptions {
  PlannerKind kind = PlannerKind::astar;
  double radius_m = 0.25;              ///< of the robot; its disc never overlaps a cell that is not drivable
  std::optional<Footprint> footprint;  ///< when given, used instead of the disc
  double preferred_clearance_m =
      0.15;                       ///< inflation: cells nearer than radius plus this to an obstacle cost more
  double clearance_weight = 1.0;  ///< up to (1 + weight) times at the edge; 0: shortest path
  AvoidedArea avoided;            ///< ignored by FootprintSearch
  /// Of MarginPlanner: how far beside a goal without a margin a path may end. Half of the arrival distance,
  /// which leaves the other half to the controller; else the robot would stop where it has not arrived.
  double goal_slack_m = 0.005;
  double turn_cost_m = 0.2;      ///< where few legs are made of a path: a turn counts as this much length
  MotionLimits limits;           ///< of `fastest`
  TurnSearchLimits turn_search;  ///< of `anyangle` and `fastest`
  SamplingOptions sampling;      ///< of the OMPL planners
  /// When given and the path violates it, the cheapest 8-connected path that meets it is taken instead,
  /// shortened as far as it still does.
  std::optional<UncertaintyConstraint> uncertainty_constraint;
};

enum class PlanFailure {
  start_outside_map,
  goal_outside_map,
  start_occupied,
  goal_occupied,
  no_path,       ///< there is none
  line_blocked,  ///< the straight line that a goal demands is not clear
  unsure,        ///< paths exist, but none found meets the UncertaintyConstraint
  limit_reached  ///< a sampling planner found none within its limits, though there may be one
};

/// Text for the operator.
std::string_view to_string(PlanFailure failure);

struct Plan {
  Path path;                 ///< few straight legs, clear but perhaps for the first out of a tight start
  std::size_t expanded = 0;  ///< expansions of grid cells and turn points, or iterations
};

using PlanResult = std::variant<Plan, PlanFailure>;

/// Headings at the start and the goal, in the map frame; `fastest` counts the turns from and to them.
struct PlanHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// Plans on an occupancy map. Keeps the data precomputed from the map and the searches' memory for many
/// queries; one query at a time.
class GridPlanner {
 public:
  explicit GridPlanner(const OccupancyMap& map, const GridPlannerOptions& options = {});
  /// Shares the field with other planners on the same map.
  GridPlanner(std::shared_ptr<const ObstacleField> field, const GridPlannerOptions& options);
  ~GridPlanner();
  GridPlanner(const GridPlanner&) = delete;
  GridPlanner& operator=(const GridPlanner&) = delete;

  /// When the start is nearer to an obstacle than the radius (a small pose error), the path first leads
  /// straight to the nearest clear cell; the goal must be clear.
  [[nodiscard]] PlanResult plan(const Vec2& start_m, const Vec2& goal_m,
                                const PlanHeadings& headings = {}) const;

  /// Is this straight leg of the robot's centre clear for its disc, or its footprint?
  [[nodiscard]] bool is_clear(const Vec2& from_m, const Vec2& to_m) const;

  /// The reachable cell centre nearest to a goal; nothing when the robot cannot leave the start. A suggestion
  /// for the operator: no plan uses it by itself.
  [[nodiscard]] std::optional<Vec2> nearest_reachable(const Vec2& start_m, const Vec2& goal_m) const;

 private:
  struct Searches;
  /// Start and goal in grid coordinates, and the clear cells between which the grid is searched.
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
  [[nodiscard]] std::vector<Vec2> cheapest_path(const Ends& ends, std::size_t& expanded) const;
  [[nodiscard]] std::vector<Vec2> cheapest_legs(const Ends& ends, const PlanHeadings& headings,
                                                std::size_t& expanded) const;
  [[nodiscard]] std::optional<std::vector<Vec2>> sampled_legs(const Ends& ends, std::size_t& expanded) const;
  [[nodiscard]] static std::vector<Vec2> points_over(std::span<const Cell> cells, const Ends& ends);
  [[nodiscard]] std::vector<Vec2> jump_path(const Ends& ends, std::size_t& expanded) const;
  void weigh_cells();
  void weigh_near_obstacles();
  void weigh_avoided();
  void prepare_searches();

  std::shared_ptr<const ObstacleField> field_;
  const OccupancyMap& map_;
  GridPlannerOptions options_;
  std::vector<float> costs_;  ///< of cells; empty: all cost 1
  std::unique_ptr<Searches> searches_;
  std::unique_ptr<FootprintPlanner> outline_;  ///< plans instead when there is a footprint
};

}  // namespace lodestar
