#include "planning/margin_planner.hpp"

#include <gtest/gtest.h>

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

constexpr double radius_m = 0.25;
const GridPlannerOptions options{.kind = PlannerKind::fastest, .radius_m = radius_m, .clearance_weight = 0.0};

/// A room of 4 x 2 m, divided by a wall with a door of `door_cm` in its middle.
OccupancyMap rooms(int door_cm) {
  std::vector<std::string> rows(200, std::string(400, '.'));
  const std::size_t low = 100 - static_cast<std::size_t>(door_cm) / 2;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (row < low || row >= low + static_cast<std::size_t>(door_cm)) rows[row].replace(200, 5, "#####");
  return map_from(rows, 0.01);
}

std::vector<Vec2> points_of(const PlanResult& result) {
  const auto* plan = std::get_if<Plan>(&result);
  return plan ? plan->path.waypoints_m : std::vector<Vec2>{};
}

bool keeps(double margin_m, const OccupancyMap& map, const std::vector<Vec2>& points) {
  GridPlannerOptions wider = options;
  wider.radius_m += margin_m;
  const GridPlanner planner(map, wider);
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!planner.is_clear(points[i - 1], points[i])) return false;
  return points.size() > 1;
}

const Vec2 start(0.6, 1.5);
const Vec2 goal(3.4, 1.4);

TEST(MarginPlanner, keeps_the_widest_margin_that_a_door_leaves) {
  for (const auto& [door_cm, margin_m] : {std::pair{61, 0.03}, std::pair{55, 0.02}, std::pair{53, 0.01}}) {
    const OccupancyMap map = rooms(door_cm);
    EXPECT_TRUE(keeps(margin_m, map, points_of(MarginPlanner(map, options).plan(start, goal)))) << door_cm;
  }
}

TEST(MarginPlanner, goes_no_long_way_round_for_a_wider_door) {
  OccupancyMap map = rooms(53);
  for (int row = 0; row < 62; ++row)
    for (int column = 0; column < map.columns; ++column)
      if (column >= 200 && column < 205) map.cells[map.index({column, row})] = OccupancyMap::free;
  const Vec2 beside_door(1.6, 1.0);
  const Vec2 behind_door(2.4, 1.0);
  const std::vector<Vec2> points = points_of(MarginPlanner(map, options).plan(beside_door, behind_door));
  EXPECT_TRUE(keeps(0.01, map, points));
  EXPECT_LT(length_m({points}), 1.0) << "through the wide door at the side it would be 1.7 m";
}

TEST(MarginPlanner, takes_no_door_without_any) {
  const OccupancyMap map = rooms(51);
  EXPECT_EQ(std::get<PlanFailure>(MarginPlanner(map, options).plan(start, goal)), PlanFailure::no_path);
  EXPECT_TRUE(std::holds_alternative<Plan>(GridPlanner(map, options).plan(start, goal)));
}

TEST(MarginPlanner, gives_up_the_margin_only_where_start_and_goal_lie_near_to_walls) {
  const OccupancyMap map = rooms(60);
  const Vec2 near_wall(0.6, 2.0 - radius_m - 0.015);
  const Vec2 beside_wall(2.05 + radius_m + 0.012, 0.4);
  const std::vector<Vec2> points = points_of(MarginPlanner(map, options).plan(near_wall, beside_wall));
  ASSERT_GT(points.size(), 3U);
  EXPECT_EQ(points.front(), near_wall);
  EXPECT_EQ(points.back(), beside_wall);
  EXPECT_TRUE(keeps(0.01, map, points));
  EXPECT_TRUE(keeps(0.03, map, {points.begin() + 1, points.end() - 1}));
  EXPECT_LT((points[1] - near_wall).norm(), 0.04);
  EXPECT_LT((points[points.size() - 2] - beside_wall).norm(), 0.04);
}

/// The controller may stop 1 cm off the goal, which at a wall would be a contact.
TEST(MarginPlanner, ends_beside_a_goal_without_a_margin_only_where_the_robot_still_arrives_there) {
  const OccupancyMap map = rooms(60);
  const Vec2 with_margin(0.6, 2.0 - radius_m - 0.01);
  for (const double slack_m : {0.005, 0.015}) {
    GridPlannerOptions slack = options;
    slack.goal_slack_m = slack_m;
    const MarginPlanner planner(map, slack);
    for (int mm = 1; mm <= 17; mm += 2) {
      const Vec2 goal_m = with_margin + Vec2(0.0, 0.001 * mm);
      const PlanResult result = planner.plan(start, goal_m);
      const std::vector<Vec2> points = points_of(result);
      ASSERT_EQ(points.empty(), 0.001 * mm > slack_m + 1e-9) << mm << " mm of " << slack_m;
      if (points.empty()) {
        EXPECT_EQ(std::get<PlanFailure>(result), PlanFailure::goal_occupied);
        continue;
      }
      EXPECT_NEAR((points.back() - goal_m).norm(), 0.001 * mm, 0.0011);
      EXPECT_TRUE(keeps(0.01, map, points));
    }
  }
}

TEST(MarginPlanner, takes_no_goal_inside_a_wall_and_offers_one_beside_it) {
  const OccupancyMap map = rooms(60);
  const Vec2 overlapping(0.6, 2.0 - radius_m + 0.02);
  const MarginPlanner planner(map, options);
  EXPECT_EQ(std::get<PlanFailure>(planner.plan(start, overlapping)), PlanFailure::goal_occupied);
  const std::optional<Vec2> offered = planner.nearest_reachable(start, overlapping);
  ASSERT_TRUE(offered);
  EXPECT_LT((*offered - overlapping).norm(), 0.05);
  EXPECT_TRUE(std::holds_alternative<Plan>(planner.plan(start, *offered)));
}

TEST(MarginPlanner, leads_out_a_robot_that_touches_a_wall) {
  const OccupancyMap map = rooms(60);
  const Vec2 touching(0.6, 2.0 - radius_m + 0.01);
  const std::vector<Vec2> points = points_of(MarginPlanner(map, options).plan(touching, goal));
  ASSERT_GT(points.size(), 2U);
  EXPECT_TRUE(keeps(0.03, map, {points.begin() + 1, points.end()}));
}

}  // namespace
}  // namespace lodestar
