#include "planning/fastest_path.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "planning/grid_planner.hpp"
#include "planning/path_draft.hpp"
#include "planning/turn_point_choice.hpp"
#include "planning/turn_shortcuts.hpp"

#include "tests/planning/sample_maps.hpp"

namespace lodestar {
namespace {

GridPlannerOptions fastest() {
  GridPlannerOptions options;
  options.kind = PlannerKind::fastest;
  options.clearance_weight = 0.0;
  return options;
}

struct Draft {
  OccupancyMap map;
  CellCosts no_costs;
  CollisionChecker space{map, 0.25};
  PathCost cost{map, no_costs, MotionLimits{}};
};

/// A hall of 200 x 100 cells with two posts that reach into it from below and above.
OccupancyMap hall_with_posts() {
  std::vector<std::string> rows(100, std::string(200, '.'));
  const auto post = [&](std::size_t x, std::size_t from, std::size_t to) {
    for (std::size_t y = from; y < to; ++y) rows[99 - y].replace(x, 4, "####");
  };
  post(60, 0, 44);
  post(130, 56, 100);
  return map_from(rows, 0.05);
}

TEST(PathDraft, leaves_out_a_turn_once_the_turns_beside_it_slide) {
  // Between the posts the direct leg is blocked; a little lower at the first and higher at the second, it is
  // not.
  const Draft draft{.map = hall_with_posts(), .no_costs = {}};
  const std::vector<Vec2> points{{20.0, 10.0}, {20.0, 48.4}, {95.0, 50.0}, {180.0, 51.6}, {180.0, 90.0}};
  PathDraft path(points, {}, draft.space, draft.cost);
  ASSERT_TRUE(path.is_clear(0, 4));
  const double before_s = draft.cost.path(path.points, {});
  ASSERT_TRUE(straighten(path, 2));
  EXPECT_EQ(path.points.size(), 4U);
  EXPECT_TRUE(path.is_clear(0, 3));
  EXPECT_LT(draft.cost.path(path.points, {}), before_s - 1.0);
}

TEST(PathDraft, changes_nothing_that_would_not_be_clear_or_cheaper) {
  Random random(11);
  int changed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Draft draft{.map = random_map(random, 80, 80, 0.001), .no_costs = {}};
    std::vector<Vec2> points;
    for (int i = 0; i < 5; ++i) points.emplace_back(random.uniform(8.0, 72.0), random.uniform(8.0, 72.0));
    PathDraft path(points, {}, draft.space, draft.cost);
    if (!path.is_clear(0, 4)) continue;
    const double before_s = draft.cost.path(points, {});
    const bool cheaper = move_turn(path, 2, 2.0) || slide_leg(path, 1, 2.0) || straighten(path, 2);
    EXPECT_TRUE(path.is_clear(0, path.points.size() - 1)) << trial;
    if (cheaper) {
      ++changed;
      EXPECT_LT(draft.cost.path(path.points, {}), before_s) << trial;
    } else {
      EXPECT_EQ(path.points, points) << trial;
    }
  }
  EXPECT_GT(changed, 10);
}

TEST(TurnShortcuts, find_the_way_around_that_has_one_turn) {
  // Three turns through the opening near the straight line, or one at the end of the wall.
  std::vector<std::string> rows(120, std::string(200, '.'));
  for (std::size_t y = 20; y < 120; ++y) rows[119 - y].replace(98, 4, "####");
  for (std::size_t y = 70; y < 90; ++y) rows[119 - y].replace(98, 4, "....");
  const Draft draft{.map = map_from(rows, 0.05), .no_costs = {}};
  const std::vector<Vec2> over{{30.0, 60.0}, {60.0, 80.0}, {140.0, 80.0}, {120.0, 60.0}, {170.0, 40.0}};
  const std::vector<Vec2> one = with_shortcuts(over, {}, draft.space, draft.cost).points;
  ASSERT_EQ(one.size(), 3U);
  EXPECT_TRUE(draft.space.along(one[0], one[1]) && draft.space.along(one[1], one[2]));
  EXPECT_LT(draft.cost.path(one, {}), draft.cost.path(over, {}) - 3.0);
}

/// The shortest way is not always the fastest: already the first round looks everywhere.
TEST(TurnPointChoice, spreads_points_on_open_ground_wherever_a_faster_path_may_lead) {
  const OccupancyMap map = map_from(std::vector<std::string>(600, std::string(600, '.')), 0.05);
  const CollisionChecker space(map, 0.25);
  TurnPointChoice choice(space, {});
  const std::vector<Vec2> known{{100.0, 300.0}, {500.0, 300.0}};
  constexpr double longest_cells = 600.0;  // its ellipse reaches 223 cells aside
  for (const int round : {0, 1, 2}) {
    double highest = 300.0;
    double lowest = 300.0;
    for (const TurnPlace& place : choice.choose(known, longest_cells, true, 100, round)) {
      EXPECT_LT((place.position - known[0]).norm() + (place.position - known[1]).norm(),
                1.15 * longest_cells);
      highest = std::max(highest, place.position.y());
      lowest = std::min(lowest, place.position.y());
    }
    EXPECT_GT(highest, 450.0) << "round " << round;
    EXPECT_LT(lowest, 150.0) << "round " << round;
  }
}

TEST(FastestPath, is_never_slower_with_more_rounds) {
  Random random(13);
  int compared = 0;
  int better = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const OccupancyMap map = random_map(random, 240, 240, 0.006);
    const Vec2 start(random.uniform(0.5, 11.5), random.uniform(0.5, 11.5));
    const Vec2 goal(random.uniform(0.5, 11.5), random.uniform(0.5, 11.5));
    const auto seconds = [&](int rounds) -> std::optional<double> {
      GridPlannerOptions options = fastest();
      options.turn_search.candidates = 60;
      options.turn_search.rounds = rounds;
      options.turn_search.work_of_rounds = 100000000;
      const PlanResult result = GridPlanner(map, options).plan(start, goal);
      const auto* plan = std::get_if<Plan>(&result);
      if (plan == nullptr) return std::nullopt;
      return travel_time_s(plan->path, std::nullopt, std::nullopt, options.limits);
    };
    const std::optional<double> one = seconds(1);
    const std::optional<double> four = seconds(4);
    ASSERT_EQ(one.has_value(), four.has_value());
    if (!one) continue;
    ++compared;
    EXPECT_LE(*four, *one + 1e-9) << trial;
    if (*four < *one - 0.01) ++better;
  }
  EXPECT_GT(compared, 15);
  EXPECT_GT(better, 0);
}

}  // namespace
}  // namespace lodestar
