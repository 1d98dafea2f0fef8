#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "app/navigation/task_thread.hpp"
#include "app/navigation/trip_planner.hpp"
#include "control/forward_clearance.hpp"
#include "maps/zones.hpp"

namespace lodestar {

/// When the control loop takes a plan.
struct PlanArrivalOptions {
  /// So many steps after it was asked for, never earlier: 100 ms at 50 Hz, twice what the longest plan may
  /// take (50 ms), so that it is ready by then on a robot as in a replay.
  std::uint64_t steps = 5;
  /// At that step the loop waits for a plan that is not ready, so that a replay gives the same bytes on every
  /// machine. On a robot it must not: the first step at which the plan is ready takes it.
  bool waits = true;
};

/// A TripPlanner on a thread of its own, beside the control loop. Plans and new maps are asked for in one
/// step and taken in a later one. All calls are from one thread.
class BackgroundPlanner {
 public:
  /// Plans around the keep-outs on every map.
  BackgroundPlanner(const OccupancyMap& map, const TripPlannerOptions& options,
                    const PlanArrivalOptions& arrival, std::vector<KeepOut> keep_out = {});

  /// Call first in each step. Is the path to be reviewed, as all plans from now on are made on another map?
  bool begin_step(std::span<const Vec2> blind_m);

  /// Prepares another map, without obstacles that it lacks. While one is being prepared, the newest waits and
  /// replaces those before it.
  void use_map(OccupancyMap map);

  /// Plans around these keep-outs instead of those before from some steps on, on the same map.
  void use_keep_out(std::vector<KeepOut> keep_out);

  /// Plans around what the map lacks from some steps on. The clearance ahead stays that of the map.
  void use_obstacles(UnmappedObstacles obstacles);

  /// Is the answer to this request on its way?
  [[nodiscard]] bool awaits(const PlanRequest& request) const { return plan_ && plan_->request == request; }
  /// Drops the answer that was awaited, if any.
  void ask(TripQuery query);
  void drop();
  /// The answer, once it has arrived. Throws what the planner threw.
  std::optional<TripPlan> take();

  /// On the newest map that is prepared and due; a keep-out bounds the clearance as a wall does.
  [[nodiscard]] const ForwardClearance& forward_clearance() const { return *prepared_.forward_clearance; }
  /// What there is to see, without the keep-outs.
  [[nodiscard]] const ObstacleField& map() const { return *prepared_.map; }

 private:
  /// What to plan on: the map, or the one before, and what it lacks.
  struct Ground {
    std::optional<OccupancyMap> map;
    bool has_other_keep_out = false;
    UnmappedObstacles obstacles;
  };
  struct Prepared {
    std::shared_ptr<const ObstacleField> map;
    std::shared_ptr<const ObstacleField> drivable;  ///< with the keep-outs; the same where there are none
    std::shared_ptr<const ForwardClearance> forward_clearance;
  };
  struct AwaitedPlan {
    PlanRequest request;
    std::future<TripPlan> answer;
    std::stop_source dropped;
    std::uint64_t due = 0;  ///< step
    bool is_on_old_map = false;
  };
  struct AwaitedGround {
    std::future<Prepared> prepared;
    std::uint64_t due = 0;
  };

  template <typename Awaited, typename Result>
  [[nodiscard]] bool has_arrived(const Awaited& awaited, const std::future<Result>& result) const;
  [[nodiscard]] Prepared prepared_on(OccupancyMap map, std::span<const KeepOut> keep_out) const;
  Ground& next_ground();
  void prepare_next(std::span<const Vec2> blind_m);

  GridPlannerOptions robot_;
  std::vector<KeepOut> keep_out_;
  UnmappedObstacles obstacles_;  ///< as last set, for the newest map
  PlanArrivalOptions arrival_;
  std::uint64_t step_ = 0;
  Prepared prepared_;
  std::optional<Ground> next_;
  std::optional<AwaitedGround> awaited_;
  std::optional<AwaitedPlan> plan_;
  bool review_is_due_ = false;
  std::optional<TripPlanner> planner_;  ///< once constructed, only the worker uses it
  TaskThread worker_;                   ///< the last member: ends before the planner does
};

}  // namespace lodestar
