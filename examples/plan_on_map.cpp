// How does a round robot get from one place to another on a ROS map?
//   plan_on_map map.yaml RADIUS_M START_X START_Y GOAL_X GOAL_Y
// Prints the waypoints in metres.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <variant>

#include "maps/map_file.hpp"
#include "planning/grid_planner.hpp"

int main(int argc, char** argv) try {
  if (argc != 7) {
    std::fprintf(stderr, "usage: plan_on_map map.yaml RADIUS_M START_X START_Y GOAL_X GOAL_Y\n");
    return 2;
  }
  const lodestar::LoadedMap loaded = lodestar::load_map(argv[1]);
  lodestar::GridPlannerOptions options;
  options.kind = lodestar::PlannerKind::fastest;
  options.radius_m = std::stod(argv[2]);
  const lodestar::Vec2 start_m(std::stod(argv[3]), std::stod(argv[4]));
  const lodestar::Vec2 goal_m(std::stod(argv[5]), std::stod(argv[6]));

  const lodestar::GridPlanner planner(loaded.map, options);
  const lodestar::PlanResult result = planner.plan(start_m, goal_m);
  if (const auto* const failure = std::get_if<lodestar::PlanFailure>(&result)) {
    const std::string_view reason = to_string(*failure);
    std::printf("no plan: %.*s\n", static_cast<int>(reason.size()), reason.data());
    return 1;
  }
  const lodestar::Path& path = std::get<lodestar::Plan>(result).path;
  for (const lodestar::Vec2& point_m : path.waypoints_m) std::printf("%.3f %.3f\n", point_m.x(), point_m.y());
  std::printf("%.3f m\n", length_m(path));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
