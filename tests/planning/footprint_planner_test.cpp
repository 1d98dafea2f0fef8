#include <gtest/gtest.h>
#include <numbers>

#include "maps/random.hpp"
#include "planning/grid_planner.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;

/// 60 cm long, 20 cm wide.
Footprint cart() {
  return Footprint({{-0.3, -0.1}, {0.3, -0.1}, {0.3, 0.1}, {-0.3, 0.1}});
}

GridPlannerOptions for_cart(PlannerKind kind) {
  return {.kind = kind, .footprint = cart(), .clearance_weight = 0.0};
}

/// Two rooms, 3 m x 3 m, and a door between them, in cells of 5 cm.
OccupancyMap rooms_with_a_narrow_door(int door_cells = 6) {
  OccupancyMap map = map_from(std::vector<std::string>(60, std::string(124, '.')), 0.05);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 60; column < 64; ++column) {
      if (row < 30 - door_cells / 2 || row >= 30 + door_cells / 2)
        map.cells[map.index({column, row})] = OccupancyMap::occupied;
    }
  }
  return map;
}

class FootprintPlan : public ::testing::TestWithParam<PlannerKind> {};

TEST_P(FootprintPlan, leads_through_a_door_too_narrow_for_the_disc) {
  const bool is_sampling = sampling_method(GetParam()).has_value();
  const OccupancyMap map = rooms_with_a_narrow_door(is_sampling ? 10 : 6);  // wider, or sampling takes long
  const Vec2 start(0.8, 0.8);
  const Vec2 goal(5.4, 0.6);
  GridPlannerOptions disc = for_cart(PlannerKind::astar);
  disc.footprint.reset();
  disc.radius_m = cart().outer_radius_m();
  EXPECT_EQ(std::get<PlanFailure>(GridPlanner(map, disc).plan(start, goal)), PlanFailure::no_path);

  GridPlannerOptions options = for_cart(GetParam());
  options.sampling.max_iterations = 100000;
  options.sampling.enough_length_m = 7.0;
  const PlanResult result =
      GridPlanner(map, options).plan(start, goal, {.start_rad = 2.0, .goal_rad = quarter});
  ASSERT_TRUE(std::holds_alternative<Plan>(result)) << to_string(std::get<PlanFailure>(result));
  const Path& path = std::get<Plan>(result).path;
  EXPECT_EQ(path.waypoints_m.front(), start);
  EXPECT_EQ(path.waypoints_m.back(), goal);
  EXPECT_TRUE(cart().is_clear_along(map, path, 2.0, quarter));
  EXPECT_LT(length_m(path), 7.0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FootprintPlan,
                         ::testing::Values(PlannerKind::astar, PlannerKind::anyangle, PlannerKind::fastest,
                                           PlannerKind::rrtstar, PlannerKind::bitstar, PlannerKind::abitstar,
                                           PlannerKind::informedrrtstar, PlannerKind::prmstar),
                         [](const auto& kind) { return std::string(to_string(kind.param)); });

TEST(FootprintPlanner, is_the_same_for_the_same_seed) {
  const OccupancyMap map = rooms_with_a_narrow_door(10);
  GridPlannerOptions options = for_cart(PlannerKind::bitstar);
  options.sampling.enough_length_m = 7.0;
  options.sampling.max_iterations = 100000;
  const auto plan = [&](std::uint32_t seed) {
    options.sampling.seed = seed;
    return std::get<Plan>(GridPlanner(map, options).plan({0.8, 0.8}, {5.4, 0.6})).path.waypoints_m;
  };
  EXPECT_EQ(plan(3), plan(3));
  EXPECT_NE(plan(3), plan(4));
}

TEST(FootprintPlanner, says_why_there_is_no_plan) {
  const OccupancyMap map = rooms_with_a_narrow_door();
  const GridPlanner planner(map, for_cart(PlannerKind::fastest));
  const auto failure = [&](const Vec2& start, const Vec2& goal, const PlanHeadings& headings) {
    return std::get<PlanFailure>(planner.plan(start, goal, headings));
  };
  const Vec2 in_the_door(3.1, 1.5);
  const Vec2 in_the_room(1.0, 1.0);
  EXPECT_EQ(failure(in_the_door, in_the_room, {.start_rad = quarter, .goal_rad = {}}),
            PlanFailure::start_occupied);
  EXPECT_EQ(failure(in_the_room, in_the_door, {.start_rad = {}, .goal_rad = quarter}),
            PlanFailure::goal_occupied);
  EXPECT_EQ(failure(in_the_room, {9.0, 1.0}, {}), PlanFailure::goal_outside_map);
  EXPECT_TRUE(std::holds_alternative<Plan>(
      planner.plan(in_the_room, in_the_door, {.start_rad = {}, .goal_rad = 0.0})));
}

/// A dead end: a corridor as wide as the door, which the cart can enter but not turn in.
TEST(FootprintPlanner, knows_that_it_cannot_turn_in_a_dead_end) {
  OccupancyMap map = map_from(std::vector<std::string>(40, std::string(80, '#')), 0.05);
  for (int row = 17; row < 23; ++row) {
    for (int column = 2; column < 78; ++column) map.cells[map.index({column, row})] = OccupancyMap::free;
  }
  const GridPlanner planner(map, for_cart(PlannerKind::fastest));
  const auto arrives = [&](double start_rad) {
    return std::holds_alternative<Plan>(
        planner.plan({0.6, 1.0}, {3.2, 1.0}, {.start_rad = start_rad, .goal_rad = {}}));
  };
  EXPECT_TRUE(arrives(0.0));
  EXPECT_FALSE(arrives(2.0 * quarter));
}

TEST(FootprintPlanner, finds_clear_paths_on_random_maps) {
  Random random(41);
  int found = 0;
  for (int trial = 0; trial < 25; ++trial) {
    const OccupancyMap map = random_map(random, 80, 60, 0.004);
    const Pose2 start{{random.uniform(0.4, 3.6), random.uniform(0.4, 2.6)}, random.uniform(-3.0, 3.0)};
    const Pose2 goal{{random.uniform(0.4, 3.6), random.uniform(0.4, 2.6)}, random.uniform(-3.0, 3.0)};
    const GridPlanner planner(map, for_cart(trial % 2 == 0 ? PlannerKind::fastest : PlannerKind::anyangle));
    const PlanResult result = planner.plan(start.position_m, goal.position_m,
                                           {.start_rad = start.yaw_rad, .goal_rad = goal.yaw_rad});
    const auto* plan = std::get_if<Plan>(&result);
    if (plan == nullptr) continue;
    ++found;
    EXPECT_TRUE(cart().is_clear_along(map, plan->path, start.yaw_rad, goal.yaw_rad)) << trial;
  }
  EXPECT_GT(found, 5);
}

}  // namespace
}  // namespace lodestar
