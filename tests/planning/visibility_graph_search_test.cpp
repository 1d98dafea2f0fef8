#include "planning/visibility_graph_search.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "planning/grid_planner.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

using std::numbers::pi;

/// Turn points around obstacle corners: 36 vertices on the full circle about every corner of every obstacle.
std::vector<Vec2> dense_turn_points(const OccupancyMap& map, const CollisionChecker& space) {
  constexpr int vertices = 36;
  const double reach = space.radius_cells() / std::cos(pi / vertices) + 1e-6;
  std::vector<Vec2> points;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (is_drivable(map.at({column, row}))) continue;
      for (int k = 0; k < 4 * vertices; ++k) {
        const Vec2 corner(column + (k & 1), row + ((k >> 1) & 1));
        const double angle = 2.0 * pi * (k / 4) / vertices;
        const Vec2 point = corner + reach * Vec2(std::cos(angle), std::sin(angle));
        if (space.along(point, point)) points.push_back(point);
      }
    }
  }
  return points;
}

/// Dijkstra on the whole visibility graph: within 0.3 % of the true optimum, which follows exact arcs.
double shortest_by_visibility_graph(const CollisionChecker& space, std::vector<Vec2> points,
                                    const Vec2& start, const Vec2& goal) {
  points.push_back(start);
  points.push_back(goal);
  std::vector<double> best(points.size(), 1e300);
  std::vector<bool> closed(points.size(), false);
  best[points.size() - 2] = 0.0;
  while (true) {
    std::size_t at = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!closed[i] && best[i] < 1e299 && (at == points.size() || best[i] < best[at])) at = i;
    }
    if (at >= points.size() - 1) return best.back();
    closed[at] = true;
    for (std::size_t to = 0; to < points.size(); ++to) {
      const double length = best[at] + (points[to] - points[at]).norm();
      if (!closed[to] && length < best[to] && space.along(points[at], points[to])) best[to] = length;
    }
  }
}

double seconds_of(const Path& path, const PlanHeadings& headings = {}) {
  return travel_time_s(path, headings.start_rad, headings.goal_rad, MotionLimits{});
}

Path path_of(const PlanResult& result) {
  EXPECT_TRUE(std::holds_alternative<Plan>(result));
  return std::get<Plan>(result).path;
}

GridPlannerOptions unweighted(PlannerKind kind, double radius_m) {
  return {.kind = kind, .radius_m = radius_m, .clearance_weight = 0.0};
}

TEST(AnyAngle, is_as_short_as_the_whole_visibility_graph_allows) {
  Random random(21);
  int compared = 0;
  double sum = 0.0;
  for (int trial = 0; trial < 200 && compared < 10; ++trial) {
    const OccupancyMap map = random_map(random, 40, 30, 0.02);
    const CollisionChecker space(map, 0.1);
    const Vec2 start(random.uniform(2.0, 12.0), random.uniform(2.0, 28.0));
    const Vec2 goal(random.uniform(28.0, 38.0), random.uniform(2.0, 28.0));
    if (!space.along(start, start) || !space.along(goal, goal) || space.along(start, goal)) continue;
    const PlanResult result = GridPlanner(map, unweighted(PlannerKind::anyangle, 0.1))
                                  .plan(map.resolution_m * start, map.resolution_m * goal);
    if (!std::holds_alternative<Plan>(result)) continue;
    ++compared;
    const double found = length_m(path_of(result)) / map.resolution_m;
    const double shortest = shortest_by_visibility_graph(space, dense_turn_points(map, space), start, goal);
    EXPECT_LT(found, 1.01 * shortest);
    sum += found / shortest;
  }
  ASSERT_EQ(compared, 10);
  EXPECT_LT(sum / compared, 1.002);
}

TEST(AnyAngle, finds_the_taut_string_of_a_point_around_a_wall) {
  // A wall 1 x 6 m from the bottom, the point passes its two upper corners.
  std::vector<std::string> rows(10, std::string(20, '.'));
  for (std::size_t row = 4; row < 10; ++row) rows[row][10] = '#';
  const OccupancyMap map = map_from(rows);
  const GridPlanner planner(map, unweighted(PlannerKind::anyangle, 0.0));
  const Path path = path_of(planner.plan({5.0, 2.0}, {16.0, 2.0}));
  EXPECT_NEAR(length_m(path), std::hypot(5.0, 4.0) + 1.0 + std::hypot(5.0, 4.0), 1e-4);
  EXPECT_EQ(path.waypoints_m.size(), 4U);
}

TEST(Fastest, is_never_slower_than_the_other_planners) {
  Random random(22);
  int compared = 0;
  double gain = 0.0;
  for (int trial = 0; trial < 40; ++trial) {
    const OccupancyMap map = random_map(random, 60, 50, 0.01);
    const Vec2 start(random.uniform(0.2, 0.8), random.uniform(0.2, 2.3));
    const Vec2 goal(random.uniform(2.2, 2.8), random.uniform(0.2, 2.3));
    const PlanHeadings headings{.start_rad = random.uniform(-pi, pi), .goal_rad = random.uniform(-pi, pi)};
    const auto seconds = [&](PlannerKind kind) -> std::optional<double> {
      const PlanResult result = GridPlanner(map, unweighted(kind, 0.12)).plan(start, goal, headings);
      if (!std::holds_alternative<Plan>(result)) return std::nullopt;
      return seconds_of(path_of(result), headings);
    };
    const auto fastest = seconds(PlannerKind::fastest);
    const auto shortest = seconds(PlannerKind::anyangle);
    const auto astar = seconds(PlannerKind::astar);
    ASSERT_EQ(fastest.has_value(), shortest.has_value());
    if (!fastest) continue;
    ++compared;
    EXPECT_LE(*fastest, *shortest * 1.02);
    EXPECT_LE(*fastest, *astar * 1.02);
    gain += *shortest / *fastest;
  }
  ASSERT_GT(compared, 20);
  EXPECT_GT(gain / compared, 1.03) << "mean time gained over the shortest path";
}

TEST(Fastest, goes_around_a_square_corner_with_one_turn) {
  std::vector<std::string> rows(40, std::string(60, '.'));
  for (std::size_t row = 20; row < 40; ++row) rows[row].replace(20, 20, std::string(20, '#'));
  const OccupancyMap map = map_from(rows, 0.05);
  const auto turns = [&](PlannerKind kind) {
    return path_of(GridPlanner(map, unweighted(kind, 0.25)).plan({0.7, 0.4}, {1.5, 1.7})).waypoints_m.size() -
           2;
  };
  EXPECT_EQ(turns(PlannerKind::fastest), 1U);
  EXPECT_GT(turns(PlannerKind::anyangle), 1U);
}

TEST(Fastest, turns_the_shorter_way_to_the_heading_wanted_at_the_goal) {
  // Left or right of a post, the path is equally long: the goal heading decides.
  std::vector<std::string> rows(41, std::string(80, '.'));
  rows[20][40] = '#';
  const OccupancyMap map = map_from(rows, 0.05);
  const GridPlanner planner(map, unweighted(PlannerKind::fastest, 0.3));
  const auto passes_above = [&](double goal_heading) {
    const Path path =
        path_of(planner.plan({1.0, 1.025}, {3.0, 1.025}, {.start_rad = {}, .goal_rad = goal_heading}));
    return path.waypoints_m.at(1).y() > 1.025;
  };
  EXPECT_TRUE(passes_above(-1.0)) << "the last leg leads down, near the goal heading";
  EXPECT_FALSE(passes_above(1.0));
}

TEST(VisibilityGraphSearch, keeps_off_walls_when_clearance_is_preferred) {
  std::vector<std::string> rows(41, std::string(60, '.'));
  for (std::size_t row = 29; row < 41; ++row) rows[row][30] = '#';
  const OccupancyMap map = map_from(rows, 0.05);
  for (const PlannerKind kind : {PlannerKind::anyangle, PlannerKind::fastest}) {
    const auto nearest_to_tip = [&](double weight) {
      const GridPlanner planner(
          map, {.kind = kind, .radius_m = 0.1, .preferred_clearance_m = 0.15, .clearance_weight = weight});
      return distance_to_path_m(path_of(planner.plan({0.3, 0.3}, {2.7, 0.3})), {1.525, 0.6});
    };
    EXPECT_LT(nearest_to_tip(0.0), 0.15);
    EXPECT_GT(nearest_to_tip(3.0), 0.17);
  }
}

}  // namespace
}  // namespace lodestar
