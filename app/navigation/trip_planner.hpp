#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/navigation/planning_context.hpp"
#include "app/navigation/unmapped_obstacles.hpp"
#include "app/site/goal.hpp"
#include "control/behaviour.hpp"
#include "planning/route.hpp"

namespace lodestar {

struct TripPlannerOptions {
  GridPlannerOptions planner;
  RouteOptions route;
  DriveOptions drive;
  /// What the map lacks is planned around on cells no larger than this: rounded to cells of 5 cm it closes
  /// gaps in which the robot has room.
  double obstacle_cell_m = 0.025;
  /// But never on more than so many, or the map's own: they are prepared anew for each such plan, a million
  /// in some 20 ms (lodestar bench plan --generated offices-5cm).
  std::size_t most_obstacle_cells = 1'000'000;
};

/// A plan request with what its answer depends on besides the map.
struct TripQuery {
  PlanRequest request;
  Trip trip;
  Pose2 map_from_base;        ///< of the robot when it asks
  std::vector<Vec2> blind_m;  ///< where it has found no marker
  std::vector<Goal> goals;    ///< to come on this trip; none: the one of the request, or of the trip's path
};

/// The way to a goal from the one before: a straight line where it asks for that (PlanFailure::line_blocked
/// where that is not clear).
PlanResult plan_leg(const Goal& goal, const Vec2& from_m, const PlanHeadings& headings,
                    const MarginPlanner& planner);

struct TripPlan {
  PlanAnswer answer;
  std::optional<RouteUpdate> update;  ///< when another path is followed from now on, or none
};

/// Answers the plan requests of the behaviour, on the present map. Where what the map lacks leaves no way
/// with room, the answer is a tight one. Without one it leads through a gap that the protective field may yet
/// let the robot pass: from near it looks otherwise. Without that either it is that of the map alone: the
/// robot drives up to what is there and waits, for it may go away.
class TripPlanner {
 public:
  TripPlanner(std::shared_ptr<const ObstacleField> field, const TripPlannerOptions& options);

  /// Plans on this map from now on, and around what it lacks.
  void use_map(std::shared_ptr<const ObstacleField> map, UnmappedObstacles obstacles,
               std::span<const Vec2> blind_m);

  TripPlan plan(const TripQuery& query);

 private:
  [[nodiscard]] PlanningContext context_on(std::shared_ptr<const ObstacleField> field) const;
  [[nodiscard]] PlanningContext context_around(std::span<const Vec2> obstacles_m) const;
  [[nodiscard]] int parts_of_a_cell() const;
  void plan_around(std::span<const Vec2> blind_m);
  const MarginPlanner& tight_planner();
  template <typename Plan>
  auto first_of(const Plan& plan);
  [[nodiscard]] TripPlan review(const RouteUpdate& update) const;
  [[nodiscard]] TripPlan replan(const RouteUpdate& update) const;
  [[nodiscard]] TripPlan another_way(const TripQuery& query) const;
  [[nodiscard]] TripPlan to_goal(const TripQuery& query);
  [[nodiscard]] TripPlan extension(const TripQuery& query);
  [[nodiscard]] TripPlan way_back(const Vec2& place_m, const Trip& trip, const Pose2& pose) const;
  [[nodiscard]] RouteUpdate route_from(const TripQuery& query);
  [[nodiscard]] PathFound along(const Route& route) const;

  TripPlannerOptions options_;
  std::shared_ptr<const ObstacleField> map_;
  UnmappedObstacles obstacles_;
  std::vector<Vec2> blind_m_;
  std::optional<PlanningContext> context_;    ///< with room around the obstacles
  std::optional<PlanningContext> tight_;      ///< with the least; made when it is asked for first
  std::optional<PlanningContext> bare_;       ///< with none; likewise
  std::optional<PlanningContext> map_alone_;  ///< likewise
  bool prefers_wide_margins_ = false;         ///< as the planning context was built for
};

}  // namespace lodestar
