#include "planning/grid_planner.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"
#include "planning/collision_checker.hpp"
#include "planning/grid_search.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

PlanFailure failure_of(const PlanResult& result) {
  EXPECT_TRUE(std::holds_alternative<PlanFailure>(result));
  return std::get<PlanFailure>(result);
}

TEST(GridSearch, is_as_cheap_as_dijkstra_on_random_maps) {
  Random random(1);
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const OccupancyMap map = random_map(random, 25, 20, 0.3);
    const CollisionChecker space(map, 0.0);
    const CellCosts costs(map.cells.size(), 1.0F);
    const Cell start{static_cast<int>(random.below(25)), static_cast<int>(random.below(20))};
    const Cell goal{static_cast<int>(random.below(25)), static_cast<int>(random.below(20))};
    const auto path = GridSearch(space, costs).find(start, goal);
    const double expected = space.at(start) ? dijkstra(map, space, start, goal) : 1e300;
    EXPECT_EQ(path.has_value(), expected < 1e299);
    if (!path) continue;
    ++found;
    EXPECT_NEAR(path->cost, expected, 1e-9);
    EXPECT_EQ(path->cells.front(), start);
    EXPECT_EQ(path->cells.back(), goal);
  }
  EXPECT_GT(found, 50);
}

TEST(CollisionChecker, agrees_with_trying_every_square) {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const OccupancyMap map = random_map(random, 20, 15, 0.08);
    const double radius_m = random.uniform(0.0, 0.2);
    const CollisionChecker space(map, radius_m);
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const bool blocked =
            !is_drivable(map.at({column, row})) || touches(map, map.center_of({column, row}), radius_m);
        EXPECT_EQ(space.at({column, row}), !blocked);
      }
    }
  }
}

TEST(CollisionChecker, legs_agree_with_dense_sampling) {
  Random random(3);
  int clear = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const OccupancyMap map = random_map(random, 16, 12, 0.04);
    const double radius_m = random.uniform(0.02, 0.12);
    const CollisionChecker space(map, radius_m);
    const Vec2 a(random.uniform(0.0, 0.8), random.uniform(0.0, 0.6));
    const Vec2 b(random.uniform(0.0, 0.8), random.uniform(0.0, 0.6));
    if (!space.along(a / map.resolution_m, b / map.resolution_m)) continue;
    ++clear;
    for (int i = 0; i <= 200; ++i) EXPECT_FALSE(touches(map, a + (b - a) * (i / 200.0), radius_m));
  }
  EXPECT_GT(clear, 100);
}

TEST(GridPlanner, never_lets_the_robot_overlap_an_obstacle) {
  Random random(4);
  int found = 0;
  constexpr std::array kinds{PlannerKind::astar, PlannerKind::anyangle, PlannerKind::fastest};
  for (std::size_t trial = 0; trial < 120; ++trial) {
    OccupancyMap map = random_map(random, 50, 40, 0.015);
    map.map_from_grid = {{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)}, random.uniform(-3.0, 3.0)};
    const GridPlanner planner(map, {.kind = kinds[trial % 3],
                                    .radius_m = 0.12,
                                    .preferred_clearance_m = 0.1,
                                    .clearance_weight = trial % 4 < 2 ? 0.0 : random.uniform(0.0, 2.0)});
    const Vec2 start = map.map_from_grid * Vec2(random.uniform(0.15, 2.3), random.uniform(0.15, 1.8));
    const Vec2 goal = map.map_from_grid * Vec2(random.uniform(0.15, 2.3), random.uniform(0.15, 1.8));
    if (touches(map, start, 0.12)) continue;
    const PlanResult result = planner.plan(start, goal);
    const auto* plan = std::get_if<Plan>(&result);
    if (plan == nullptr) continue;
    ++found;
    const auto& points = plan->path.waypoints_m;
    EXPECT_EQ(points.front(), start);
    EXPECT_EQ(points.back(), goal);
    for (std::size_t i = 1; i < points.size(); ++i) {
      for (int k = 0; k <= 50; ++k)
        EXPECT_FALSE(touches(map, points[i - 1] + (points[i] - points[i - 1]) * (k / 50.0), 0.12));
    }
  }
  EXPECT_GT(found, 30);
}

TEST(GridPlanner, goes_straight_where_nothing_is_in_the_way) {
  const OccupancyMap map = map_from({"..........", "..........", "..........", ".........."}, 1.0);
  const PlanResult result =
      GridPlanner(map, {.radius_m = 0.3, .clearance_weight = 0.0}).plan({0.7, 0.6}, {9.1, 3.2});
  EXPECT_EQ(std::get<Plan>(result).path.waypoints_m.size(), 2U);
}

TEST(GridPlanner, finds_the_gap_and_passes_one_just_as_wide_as_the_robot) {
  const OccupancyMap map =
      map_from({".....#.....", ".....#.....", "...........", ".....#.....", ".....#....."}, 0.5);
  const Vec2 start(0.75, 0.75);
  const Vec2 goal(4.75, 1.75);
  EXPECT_TRUE(std::holds_alternative<Plan>(GridPlanner(map, {.radius_m = 0.25}).plan(start, goal)));
  EXPECT_EQ(failure_of(GridPlanner(map, {.radius_m = 0.26}).plan(start, goal)), PlanFailure::no_path);
}

TEST(GridPlanner, says_why_there_is_no_plan) {
  const OccupancyMap map = map_from({"....#....", "....#..?.", "....#...."}, 1.0);
  const GridPlanner planner(map, {.radius_m = 0.3});
  const Vec2 good(1.5, 1.5);
  EXPECT_EQ(failure_of(planner.plan({-1.0, 1.0}, good)), PlanFailure::start_outside_map);
  EXPECT_EQ(failure_of(planner.plan({std::nan(""), 1.0}, good)), PlanFailure::start_outside_map);
  EXPECT_EQ(failure_of(planner.plan(good, {99.0, 1.0})), PlanFailure::goal_outside_map);
  EXPECT_EQ(failure_of(planner.plan(good, {1.0, std::nan("")})), PlanFailure::goal_outside_map);
  EXPECT_EQ(failure_of(planner.plan({4.5, 1.5}, good)), PlanFailure::start_occupied);
  EXPECT_EQ(failure_of(planner.plan(good, {4.5, 1.5})), PlanFailure::goal_occupied);
  EXPECT_EQ(failure_of(planner.plan(good, {3.9, 1.5})), PlanFailure::goal_occupied)
      << "the footprint would overlap the wall";
  EXPECT_EQ(failure_of(planner.plan(good, {7.5, 1.5})), PlanFailure::goal_occupied) << "unknown is not free";
  EXPECT_EQ(failure_of(planner.plan(good, {6.0, 1.5})), PlanFailure::no_path);
}

TEST(GridPlanner, leads_out_a_robot_that_stands_too_near_to_a_wall) {
  const OccupancyMap map = map_from({"#.......", "#.......", "#......."}, 0.5);
  const GridPlanner planner(map, {.radius_m = 0.3});
  const PlanResult result = planner.plan({0.7, 0.75}, {3.0, 0.75});  // 20 cm from the wall
  ASSERT_TRUE(std::holds_alternative<Plan>(result));
  EXPECT_EQ(std::get<Plan>(result).path.waypoints_m.front(), Vec2(0.7, 0.75));
}

TEST(GridPlanner, has_a_path_to_where_it_stands) {
  const OccupancyMap map = map_from({"....", "....", "...."}, 1.0);
  const PlanResult result = GridPlanner(map, {.radius_m = 0.3}).plan({1.2, 1.3}, {1.2, 1.3});
  ASSERT_TRUE(std::holds_alternative<Plan>(result));
  EXPECT_NEAR(length_m(std::get<Plan>(result).path), 0.0, 1.0);
}

TEST(GridPlanner, keeps_off_walls_when_clearance_is_preferred) {
  std::vector<std::string> rows(21, std::string(60, '.'));
  for (int row = 0; row < 12; ++row) rows[static_cast<std::size_t>(20 - row)][30] = '#';
  const OccupancyMap map = map_from(rows, 0.05);
  const auto nearest_to_tip = [&](double weight) {
    const PlanResult result =
        GridPlanner(map, {.radius_m = 0.1, .preferred_clearance_m = 0.15, .clearance_weight = weight})
            .plan({0.3, 0.3}, {2.7, 0.3});
    return distance_to_path_m(std::get<Plan>(result).path, {1.525, 0.6});
  };
  EXPECT_LT(nearest_to_tip(0.0), 0.15);
  EXPECT_GT(nearest_to_tip(3.0), 0.18);
}

TEST(GridPlanner, goes_round_shunned_ground_unless_that_is_far_longer) {
  std::vector<std::string> rows(40, std::string(60, '.'));
  for (std::size_t row = 10; row < 30; ++row) rows[row].replace(10, 40, std::string(40, '#'));
  const OccupancyMap map = map_from(rows, 0.1);  // a block with an aisle of 1 m above and below
  const Vec2 start_m(0.5, 1.2);
  const Vec2 goal_m(5.5, 1.2);
  const auto highest_m = [&](PlannerKind kind, double weight) {
    const GridPlannerOptions options{
        .kind = kind,
        .radius_m = 0.2,
        .avoided = {.places_m = {{3.0, 0.5}}, .within_m = 1.0, .weight = weight}};
    const PlanResult result = GridPlanner(map, options).plan(start_m, goal_m);
    double highest = 0.0;
    for (const Vec2& waypoint_m : std::get<Plan>(result).path.waypoints_m)
      highest = std::max(highest, waypoint_m.y());
    return highest;
  };
  for (const PlannerKind kind : {PlannerKind::astar, PlannerKind::anyangle, PlannerKind::fastest}) {
    EXPECT_LT(highest_m(kind, 0.1), 1.3);
    EXPECT_GT(highest_m(kind, 10.0), 3.0);
  }
}

TEST(GridPlanner, answers_with_clearance_also_when_the_cheapest_path_takes_too_long_to_find) {
  Random random(6);
  const OccupancyMap map = random_map(random, 80, 60, 0.02);
  GridPlannerOptions options{.kind = PlannerKind::fastest, .radius_m = 0.1};
  const auto plan = [&] { return GridPlanner(map, options).plan({0.3, 0.3}, {3.7, 2.7}); };
  const PlanResult whole = plan();
  options.turn_search.cells = 20;
  const PlanResult limited = plan();
  ASSERT_TRUE(std::holds_alternative<Plan>(whole));
  ASSERT_TRUE(std::holds_alternative<Plan>(limited));
  EXPECT_LT(std::get<Plan>(limited).expanded, std::get<Plan>(whole).expanded);
}

TEST(GridPlanner, answers_the_same_every_time) {
  Random random(5);
  const OccupancyMap map = random_map(random, 80, 60, 0.02);
  const GridPlanner planner(map, {.radius_m = 0.1});
  const GridPlanner again(map, {.radius_m = 0.1});
  const PlanResult first = planner.plan({0.3, 0.3}, {3.7, 2.7});
  const PlanResult second = again.plan({0.3, 0.3}, {3.7, 2.7});
  ASSERT_TRUE(std::holds_alternative<Plan>(first));
  ASSERT_TRUE(std::holds_alternative<Plan>(second));
  EXPECT_GT(std::get<Plan>(first).path.waypoints_m.size(), 2U) << "a path with turns";
  EXPECT_EQ(std::get<Plan>(first).path.waypoints_m, std::get<Plan>(second).path.waypoints_m);
}

}  // namespace
}  // namespace lodestar
