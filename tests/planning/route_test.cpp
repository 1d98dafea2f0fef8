#include "planning/route.hpp"

#include <gtest/gtest.h>

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

/// A hall of 4 x 2 m; the wall in its middle leaves a passage above and one below, each if open.
OccupancyMap hall(bool open_above, bool open_below = true) {
  std::vector<std::string> rows(40, std::string(80, '.'));
  for (std::size_t row = 0; row < 40; ++row) {
    const bool above = row < 12;
    const bool below = row >= 28;
    if ((above && open_above) || (below && open_below)) continue;
    rows[row][40] = '#';
  }
  return map_from(rows, 0.05);
}

const GridPlannerOptions options{.kind = PlannerKind::fastest, .radius_m = 0.2, .clearance_weight = 0.0};
const Vec2 start(0.5, 1.1);
const Vec2 goal(3.5, 1.1);

Route route_in(const OccupancyMap& map) {
  return {std::get<Plan>(MarginPlanner(map, options).plan(start, goal)).path, std::nullopt};
}

bool passes_above(const Path& path) {
  return path.waypoints_m.at(1).y() > 1.0;
}

TEST(Route, keeps_its_waypoints_while_nothing_changes) {
  const OccupancyMap map = hall(true);
  const MarginPlanner planner(map, options);
  const Route route = route_in(map);
  const RouteUpdate update = updated(route, {start, 0.0}, planner);
  EXPECT_EQ(update.change, RouteChange::kept);
  EXPECT_EQ(update.route.path.waypoints_m, route.path.waypoints_m);
}

TEST(Route, drops_what_was_passed) {
  const Path path{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}};
  EXPECT_EQ(rest_of(path, {0.4, 0.05}).waypoints_m, (std::vector<Vec2>{{0.4, 0.05}, {1.0, 0.0}, {1.0, 1.0}}));
  EXPECT_EQ(rest_of(path, {1.0, 0.0}).waypoints_m, (std::vector<Vec2>{{1.0, 0.0}, {1.0, 1.0}}));
  EXPECT_EQ(rest_of(path, {1.02, 0.5}).waypoints_m, (std::vector<Vec2>{{1.02, 0.5}, {1.0, 1.0}}));
}

TEST(Route, does_not_waver_between_two_ways_that_are_nearly_as_good) {
  const Route below = route_in(hall(false));
  ASSERT_FALSE(passes_above(below.path));
  // The passage above opens. It is a little shorter from here, but by too little to turn around.
  const OccupancyMap open = hall(true);
  const MarginPlanner planner(open, options);
  ASSERT_TRUE(passes_above(route_in(open).path));
  const RouteUpdate update = updated(below, {start, 0.0}, planner);
  EXPECT_EQ(update.change, RouteChange::kept);
  EXPECT_FALSE(passes_above(update.route.path));
}

TEST(Route, takes_a_way_that_is_clearly_better) {
  Route detour;
  detour.path.waypoints_m = {start, {0.5, 0.3}, {3.0, 0.3}, {3.0, 1.7}, {3.7, 1.7}, goal};
  const OccupancyMap map = hall(true);
  EXPECT_EQ(updated(detour, {start, 0.0}, MarginPlanner(map, options)).change, RouteChange::better);
}

TEST(Route, is_planned_anew_when_something_stands_in_its_way) {
  const Route below = route_in(hall(false));
  const OccupancyMap closed_below = hall(true, false);
  const RouteUpdate update = updated(below, {start, 0.0}, MarginPlanner(closed_below, options));
  EXPECT_EQ(update.change, RouteChange::blocked);
  EXPECT_TRUE(passes_above(update.route.path));
}

TEST(Route, is_planned_anew_when_the_robot_is_not_on_it) {
  const OccupancyMap map = hall(true);
  const RouteUpdate update = updated(route_in(map), {{0.5, 0.3}, 0.0}, MarginPlanner(map, options));
  EXPECT_EQ(update.change, RouteChange::left_path);
  EXPECT_EQ(update.route.path.waypoints_m.front(), Vec2(0.5, 0.3));
}

TEST(Route, says_why_it_is_lost) {
  const OccupancyMap closed = hall(false, false);
  const RouteUpdate update = updated(route_in(hall(true)), {start, 0.0}, MarginPlanner(closed, options));
  EXPECT_EQ(update.change, RouteChange::lost);
  EXPECT_EQ(update.failure, PlanFailure::no_path);
  EXPECT_TRUE(update.route.path.waypoints_m.empty());
}

TEST(NearestReachable, is_this_side_of_a_closed_wall) {
  const OccupancyMap closed = hall(false, false);
  const MarginPlanner planner(closed, options);
  const auto nearest = planner.nearest_reachable(start, goal);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->x(), 1.775, 1e-9);
  EXPECT_TRUE(std::holds_alternative<Plan>(planner.plan(start, *nearest)));
  EXPECT_EQ(planner.nearest_reachable({-1.0, 0.0}, goal), std::nullopt);
}

}  // namespace
}  // namespace lodestar
