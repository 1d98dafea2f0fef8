#include "app/bench/plan_beside.hpp"

#include <algorithm>

#include "app/navigation/background_planner.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {
namespace {

constexpr Duration control_period = std::chrono::milliseconds(20);

TripQuery trip_over(const PlanQuery& query) {
  return {.request = {.kind = PlanKind::new_goal, .goal_m = query.goal_m},
          .trip = {RotateThenDrive({}, std::nullopt, {}), std::nullopt, false},
          .map_from_base = {query.start_m, 0.0}};
}

}  // namespace

PlanBesideResult bench_plan_beside(const OccupancyMap& map, const GridPlannerOptions& planner,
                                   const std::vector<PlanQuery>& queries, Duration duration) {
  constexpr double look_ahead_m = 3.0;
  constexpr Duration new_map_after = std::chrono::seconds(1);
  BackgroundPlanner beside(map, {.planner = planner}, {.steps = 1, .waits = false});
  PlanBesideResult result;
  std::size_t current = 0;
  Stamp next = monotonic_now();
  Stamp last = next;
  Stamp map_is_due = next + new_map_after;
  const Stamp end = next + duration;
  while (last < end && !queries.empty()) {
    next = std::max(next + control_period, monotonic_now());
    sleep_until(next);
    const Stamp now = monotonic_now();
    result.period_ms.push_back(1e3 * seconds(now - last));
    last = now;
    result.new_maps += beside.begin_step({}) ? 1 : 0;
    const TripQuery query = trip_over(queries[current]);
    if (!beside.awaits(query.request)) beside.ask(query);
    if (beside.take()) {
      ++result.plans;
      current = (current + 1) % queries.size();
    }
    (void)beside.forward_clearance().ahead_m(query.map_from_base, look_ahead_m);
    if (now < map_is_due) continue;
    beside.use_map(map);
    map_is_due = now + new_map_after;
  }
  return result;
}

}  // namespace lodestar
