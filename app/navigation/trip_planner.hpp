#pragma once

#include <memory>
#include <optional>
#include <span>

#include "app/navigation/planning_context.hpp"
#include "control/behaviour.hpp"
#include "planning/route.hpp"

namespace lodestar {

struct TripPlannerOptions {
  GridPlannerOptions planner;
  RouteOptions route;
  DriveOptions drive;
};

/// Answers the plan requests of the behaviour, on the present map.
class TripPlanner {
 public:
  TripPlanner(const OccupancyMap& map, const TripPlannerOptions& options);

  /// `blind_m`: where the robot has found no marker.
  void map_changed(const OccupancyMap& map, std::span<const Vec2> blind_m);

  struct Planned {
    PlanAnswer answer;
    std::optional<RouteUpdate> update;  ///< when another path is followed from now on, or none
  };
  Planned plan(const PlanRequest& request, const Trip& trip, const Pose2& pose,
               std::span<const Vec2> blind_m);

  [[nodiscard]] const ForwardClearance& forward_clearance() const { return context_->forward_clearance; }

 private:
  void rebuild_context(const OccupancyMap& map, std::span<const Vec2> blind_m);
  [[nodiscard]] Planned review(const RouteUpdate& update) const;
  [[nodiscard]] Planned replan(const RouteUpdate& update) const;
  [[nodiscard]] Planned another_way(const Trip& trip, const Pose2& pose) const;
  [[nodiscard]] Planned to_goal(const PlanRequest& request, const Pose2& pose) const;
  [[nodiscard]] Planned way_back(const Vec2& place_m, const Trip& trip, const Pose2& pose) const;
  [[nodiscard]] RouteUpdate route_from(const PlanRequest& request, const Trip& trip, const Pose2& pose) const;
  [[nodiscard]] PathFound along(const Route& route) const;

  TripPlannerOptions options_;
  std::unique_ptr<const PlanningContext> context_;
  bool prefers_wide_margins_ = false;  ///< as the planning context was built for
};

}  // namespace lodestar
