#include "app/navigation/background_planner.hpp"

#include <gtest/gtest.h>
#include <stdexcept>
#include <thread>

#include "tests/app/navigation/lab.hpp"
#include "tests/maps/cast_scan.hpp"

namespace lodestar {
namespace {

const Vec2 near_m{2.2, 5.0};
const Vec2 far_m{13.0, 2.0};

TripPlannerOptions planner_options() {
  const NavigationOptions options = navigation_options(lab().robot);
  return {.planner = options.planner, .route = options.route, .drive = options.drive};
}

TripQuery query_to(const Vec2& goal_m) {
  return {.request = {.kind = PlanKind::new_goal, .goal_m = goal_m},
          .trip = {RotateThenDrive({}, std::nullopt, planner_options().drive), std::nullopt, false},
          .map_from_base = lab().start};
}

OccupancyMap with_wall(OccupancyMap map, double x_m) {
  for (double y_m = 0.0; y_m < 7.4; y_m += 0.5 * map.resolution_m)
    map.cells[map.index(map.cell_at({x_m, y_m}))] = OccupancyMap::occupied;
  return map;
}

/// The steps until the awaited plan is taken; its own number counts too.
int steps_until_taken(BackgroundPlanner& planner, std::optional<TripPlan>& plan) {
  for (int steps = 1;; ++steps) {
    planner.begin_step({});
    if (plan = planner.take(); plan) return steps;
  }
}

TEST(TaskThread, does_its_tasks_in_turn_and_hands_on_what_they_throw) {
  TaskThread worker;
  std::vector<int> done;
  worker.run([&] { done.push_back(1); });
  std::future<void> failed = worker.run([&] { throw std::runtime_error("no memory"); });
  std::future<int> last = worker.run([&] {
    done.push_back(2);
    return 3;
  });
  EXPECT_THROW(failed.get(), std::runtime_error);
  EXPECT_EQ(last.get(), 3);
  EXPECT_EQ(done, (std::vector{1, 2}));
}

TEST(BackgroundPlanner, has_a_plan_arrive_at_the_stated_step_however_long_it_takes) {
  for (const std::uint64_t steps : {0U, 1U, 5U, 12U}) {
    BackgroundPlanner planner(lab().map.map, planner_options(), {.steps = steps, .waits = true});
    planner.begin_step({});
    planner.ask(query_to(far_m));
    std::optional<TripPlan> plan;
    if (steps == 0) {
      plan = planner.take();
      ASSERT_TRUE(plan);
    } else {
      EXPECT_FALSE(planner.take());
      EXPECT_EQ(steps_until_taken(planner, plan), static_cast<int>(steps));
    }
    ASSERT_TRUE(plan->update);
    EXPECT_EQ(plan->update->route.path.waypoints_m.back(), far_m);
  }
}

TEST(BackgroundPlanner, that_does_not_wait_hands_out_no_plan_before_its_step) {
  BackgroundPlanner planner(lab().map.map, planner_options(), {.steps = 5, .waits = false});
  planner.begin_step({});
  planner.ask(query_to(near_m));
  std::optional<TripPlan> plan;
  for (int step = 0; !plan; ++step) {
    plan = planner.take();
    ASSERT_TRUE(!plan || step >= 5) << step;
    planner.begin_step({});
    std::this_thread::yield();
  }
  EXPECT_TRUE(std::holds_alternative<PathFound>(plan->answer));
}

TEST(BackgroundPlanner, says_why_there_is_no_path) {
  BackgroundPlanner planner(with_wall(lab().map.map, 8.9), planner_options(), {});
  planner.ask(query_to(far_m));
  std::optional<TripPlan> plan;
  steps_until_taken(planner, plan);
  EXPECT_TRUE(std::holds_alternative<PathNotFound>(plan->answer));
  ASSERT_TRUE(plan->update);
  EXPECT_EQ(plan->update->failure, PlanFailure::no_path);
}

TEST(BackgroundPlanner, answers_only_the_newest_request) {
  BackgroundPlanner planner(lab().map.map, planner_options(), {});
  planner.ask(query_to(near_m));
  planner.begin_step({});
  planner.ask(query_to(far_m));
  EXPECT_FALSE(planner.awaits(query_to(near_m).request));
  EXPECT_TRUE(planner.awaits(query_to(far_m).request));
  std::optional<TripPlan> plan;
  EXPECT_EQ(steps_until_taken(planner, plan), 5);
  EXPECT_EQ(plan->update->route.path.waypoints_m.back(), far_m);
}

TEST(BackgroundPlanner, never_hands_out_a_dropped_plan) {
  BackgroundPlanner planner(lab().map.map, planner_options(), {});
  planner.ask(query_to(near_m));
  planner.drop();
  for (int step = 0; step < 20; ++step) {
    planner.begin_step({});
    EXPECT_FALSE(planner.take());
  }
}

TEST(BackgroundPlanner, plans_on_a_new_map_and_has_what_was_asked_before_reviewed) {
  const OccupancyMap map = lab().map.map;
  BackgroundPlanner planner(map, planner_options(), {});
  const Pose2 towards_wall{{8.0, 3.4}, 0.0};
  const double before_m = planner.forward_clearance().ahead_m(towards_wall, 3.0);
  planner.ask(query_to(far_m));
  planner.use_map(with_wall(map, 8.9));
  EXPECT_TRUE(planner.begin_step({})) << "the map is another from here on";
  std::optional<TripPlan> plan;
  EXPECT_EQ(steps_until_taken(planner, plan), 4);
  EXPECT_TRUE(std::holds_alternative<PathFound>(plan->answer)) << "asked before the wall was known";
  EXPECT_EQ(planner.forward_clearance().ahead_m(towards_wall, 3.0), before_m);
  EXPECT_TRUE(planner.begin_step({})) << "that plan needs a review";
  EXPECT_LT(planner.forward_clearance().ahead_m(towards_wall, 3.0), before_m);
  EXPECT_FALSE(planner.begin_step({}));
  planner.ask(query_to(far_m));
  steps_until_taken(planner, plan);
  EXPECT_TRUE(std::holds_alternative<PathNotFound>(plan->answer));
}

TEST(BackgroundPlanner, prepares_only_the_newest_of_many_maps) {
  const OccupancyMap map = lab().map.map;
  BackgroundPlanner planner(map, planner_options(), {});
  int changes = 0;
  for (int step = 0; step < 10; ++step) {  // one each step, more than are prepared
    planner.use_map(with_wall(map, step < 9 ? 3.0 : 8.9));
    changes += planner.begin_step({}) ? 1 : 0;
  }
  for (int step = 0; step < 10; ++step) changes += planner.begin_step({}) ? 1 : 0;
  EXPECT_EQ(changes, 3) << "the first, the newest five steps later, and the last";
  EXPECT_LT(planner.forward_clearance().ahead_m({{8.0, 3.4}, 0.0}, 3.0), 1.0);
}

TEST(BackgroundPlanner, obeys_keep_outs_on_every_map_and_shows_none_of_them) {
  const OccupancyMap map = lab().map.map;
  const KeepOut across{"across", {{8.8, -1.0}, {9.0, -1.0}, {9.0, 9.0}, {8.8, 9.0}}};
  BackgroundPlanner planner(map, planner_options(), {}, {across});
  for (int round = 0; round < 3; ++round) {
    planner.ask(query_to(far_m));
    std::optional<TripPlan> plan;
    steps_until_taken(planner, plan);
    EXPECT_TRUE(std::holds_alternative<PathNotFound>(plan->answer)) << round;
    EXPECT_LT(planner.forward_clearance().ahead_m({{8.0, 3.4}, 0.0}, 3.0), 0.6) << round;
    EXPECT_EQ(planner.map().map().cells, map.cells) << "no beam of a scanner ends at a keep-out";
    if (round == 0) planner.use_map(map);
    if (round == 1) planner.use_obstacles({.roomy_m = {{3.0, 5.0}}, .tight_m = {{3.0, 5.0}}});
    for (int step = 0; step < 10; ++step) planner.begin_step({});
  }
}

TEST(BackgroundPlanner, obeys_keep_outs_that_are_set_later_and_keeps_what_it_knows_to_stand_about) {
  const OccupancyMap map = lab().map.map;
  const KeepOut across{"across", {{8.8, -1.0}, {9.0, -1.0}, {9.0, 9.0}, {8.8, 9.0}}};
  BackgroundPlanner planner(map, planner_options(), {});
  const Vec2 thing_m{1.7, 5.3};  // on the straight way to near_m
  const auto path_to = [&](const Vec2& goal_m) {
    for (int step = 0; step < 10; ++step) planner.begin_step({});
    planner.ask(query_to(goal_m));
    std::optional<TripPlan> plan;
    steps_until_taken(planner, plan);
    const bool is_found = std::holds_alternative<PathFound>(plan->answer);
    return is_found ? std::optional(plan->update->route.path) : std::nullopt;
  };
  const auto goes_around = [&] { return distance_to_path_m(path_to(near_m).value(), thing_m) > 0.25; };
  ASSERT_FALSE(goes_around());
  planner.use_obstacles({.roomy_m = {thing_m}, .tight_m = {thing_m}});
  ASSERT_TRUE(path_to(far_m));
  ASSERT_TRUE(goes_around());

  planner.use_keep_out({across});
  EXPECT_TRUE(planner.begin_step({})) << "the present path needs a review";
  EXPECT_FALSE(path_to(far_m));
  EXPECT_TRUE(goes_around()) << "the obstacle is forgotten";
  EXPECT_EQ(planner.map().map().cells, map.cells);

  planner.use_keep_out({});
  EXPECT_TRUE(path_to(far_m));
  EXPECT_TRUE(goes_around()) << "the obstacle is forgotten";
}

/// Points across the way to near_m, with a gap in it.
std::vector<Vec2> fence_m(double gap_from_y_m, double gap_to_y_m) {
  std::vector<Vec2> points_m;
  for (double y_m = 0.0; y_m < 7.5; y_m += 0.05)
    if (y_m < gap_from_y_m || y_m > gap_to_y_m) points_m.push_back({1.7, y_m});
  return points_m;
}

Path path_around(BackgroundPlanner& planner, const UnmappedObstacles& obstacles) {
  planner.use_obstacles(obstacles);
  for (int step = 0; step < 10; ++step) planner.begin_step({});
  planner.ask(query_to(near_m));
  std::optional<TripPlan> plan;
  steps_until_taken(planner, plan);
  return plan->update->route.path;
}

bool keeps_off(const Path& path, const std::vector<Vec2>& points_m) {
  return std::ranges::all_of(points_m,
                             [&](const Vec2& point_m) { return distance_to_path_m(path, point_m) > 0.25; });
}

TEST(BackgroundPlanner, leads_close_past_obstacles_where_there_is_no_way_with_room_and_else_up_to_them) {
  BackgroundPlanner planner(lab().map.map, planner_options(), {});
  const std::vector<Vec2> closed = fence_m(9.0, 9.0);
  const std::vector<Vec2> narrow = fence_m(5.2, 6.0);
  const std::vector<Vec2> aside = fence_m(4.4, 5.3);
  EXPECT_TRUE(keeps_off(path_around(planner, {.roomy_m = aside, .tight_m = narrow}), aside))
      << "room comes first";
  const Path tight = path_around(planner, {.roomy_m = closed, .tight_m = narrow});
  EXPECT_TRUE(keeps_off(tight, narrow));
  EXPECT_FALSE(keeps_off(tight, closed));
  const Path up_to_gap = path_around(planner, {.roomy_m = closed, .tight_m = closed, .bare_m = narrow});
  EXPECT_TRUE(keeps_off(up_to_gap, narrow)) << "the field may let it pass";
  const Path up_to_it = path_around(planner, {.roomy_m = closed, .tight_m = closed, .bare_m = closed});
  EXPECT_FALSE(keeps_off(up_to_it, closed)) << "they may go away";
}

TEST(BackgroundPlanner, leads_close_past_obstacles_before_a_long_detour) {
  BackgroundPlanner planner(testing::walled_room(10.0, 7.5), planner_options(), {});
  const std::vector<Vec2> far = fence_m(0.4, 1.8);
  EXPECT_TRUE(keeps_off(path_around(planner, {.roomy_m = far, .tight_m = far}), far));
  EXPECT_FALSE(keeps_off(path_around(planner, {.roomy_m = far, .tight_m = fence_m(5.2, 6.0)}), far));
}

/// From afar another way looks wider, from near it may not: a robot that turned for each centimetre went to
/// and fro.
TEST(BackgroundPlanner, leaves_a_way_that_can_be_passed_for_a_step_aside_alone) {
  BackgroundPlanner planner(testing::walled_room(10.0, 7.5), planner_options(), {});
  const auto path_after = [&](const Path& path, UnmappedObstacles obstacles) {
    planner.use_obstacles(std::move(obstacles));
    for (int step = 0; step < 10; ++step) planner.begin_step({});
    TripQuery query = query_to(near_m);
    query.request.kind = PlanKind::replan;
    query.trip.drive = RotateThenDrive(path, std::nullopt, {});
    planner.ask(query);
    std::optional<TripPlan> plan;
    steps_until_taken(planner, plan);
    return plan->update ? plan->update->route.path : path;
  };
  const std::vector<Vec2> tight = fence_m(4.9, 5.6);
  const std::vector<Vec2> aside = fence_m(5.2, 6.0);
  const std::vector<Vec2> far = fence_m(3.9, 4.6);
  const Path way = path_around(planner, {.roomy_m = tight, .tight_m = tight});
  const auto with = [&](const std::vector<Vec2>& roomy, bool is_passable) {
    return UnmappedObstacles{
        .roomy_m = roomy, .tight_m = tight, .bare_m = {}, .path_is_passable = is_passable};
  };
  EXPECT_TRUE(keeps_off(path_after(way, with(aside, true)), aside));
  EXPECT_TRUE(keeps_off(path_after(way, with(far, true)), tight)) << "that would be a detour";
  EXPECT_TRUE(keeps_off(path_after(way, with(far, false)), far)) << "what cannot be passed is left for it";
}

/// 3 cm more than the robot needs; rounded to the map's cells, 2 cm less.
TEST(BackgroundPlanner, leads_through_gaps_that_end_within_cells) {
  BackgroundPlanner planner(testing::walled_room(10.0, 7.5), planner_options(), {});
  std::vector<Vec2> narrow = fence_m(5.2, 5.8);
  narrow.insert(narrow.end(), {{1.7, 5.244}, {1.7, 5.796}});
  EXPECT_TRUE(keeps_off(path_around(planner, {.roomy_m = narrow, .tight_m = narrow}), narrow));
}

}  // namespace
}  // namespace lodestar
