#include "drivers/simulation/walkers.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "drivers/simulation/disc_contact.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

constexpr Duration step = std::chrono::milliseconds(10);

/// 12 m x 8 m with a wall in the middle that has a door of 1.2 m.
OccupancyMap two_rooms() {
  OccupancyMap map = empty_floor(240, 160, 0.05);
  for (int row = 0; row < map.rows; ++row)
    if (row < 68 || row >= 92) map.cells[map.index({120, row})] = OccupancyMap::occupied;
  return map;
}

const Pose2 robot{{2.0, 2.0}, 0.0};

TEST(Walkers, walk_about_within_their_limits) {
  const OccupancyMap map = two_rooms();
  const PeopleOptions options{.count = 6, .threatening_share = 0.0};
  Walkers people(map, options, robot, 3);
  ASSERT_EQ(people.walkers().size(), 6U);
  std::vector<Walker> before = people.walkers();
  for (const Walker& walker : before) EXPECT_GE((walker.disc.position_m - robot.position_m).norm(), 2.0);
  double fastest_mps = 0.0;
  for (int i = 0; i < 6000; ++i) {
    people.step(step, robot);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const DiscState& now = people.walkers()[k].disc;
      const double speed_mps = now.velocity_mps.norm();
      ASSERT_FALSE(disc_overlaps_obstacle(map, now.position_m, options.radius_m))
          << "in a wall at step " << i;
      ASSERT_LE(speed_mps, options.fastest_mps + 1e-9);
      ASSERT_LE(speed_mps - before[k].disc.velocity_mps.norm(), 0.01 * options.max_acceleration_mps2 + 1e-9);
      fastest_mps = std::max(fastest_mps, speed_mps);
    }
    before = people.walkers();
  }
  EXPECT_GT(fastest_mps, 1.2);
  for (const Walker& walker : before) EXPECT_GT(walker.disc.walked_m, 15.0) << "of some 80 m in a minute";
}

/// A box in the door, and one in the middle of each room.
TEST(Walkers, go_around_things_and_never_through_them) {
  const OccupancyMap map = two_rooms();
  const PeopleOptions options{.count = 6, .threatening_share = 0.0};
  Walkers people(map, options, robot, 3);
  std::vector<DiscState> things;
  for (const Vec2& place_m : {Vec2(6.0, 3.8), Vec2(3.0, 4.0), Vec2(9.0, 4.0)})
    things.push_back({.radius_m = 0.3, .position_m = place_m});
  const double apart_m = options.radius_m + 0.3 - 0.02;
  for (int i = 0; i < 6000; ++i) {
    people.step(step, robot, things);
    if (i < 200) continue;  // who began in one has left it
    for (const Walker& walker : people.walkers())
      for (const DiscState& thing : things)
        ASSERT_GT((walker.disc.position_m - thing.position_m).norm(), apart_m) << i;
  }
}

/// It stands in the door, where who does not see it would walk through.
TEST(Walkers, who_do_not_see_the_robot_run_against_it_and_not_through_it) {
  const OccupancyMap map = two_rooms();
  const PeopleOptions options{
      .count = 6, .oblivious_share = 1.0, .threatening_share = 0.0, .robot_radius_m = 0.3};
  const Pose2 in_door{{6.0, 4.0}, 0.0};
  Walkers people(map, options, in_door, 3);
  const double apart_m = options.radius_m + options.robot_radius_m;
  double least_m = 100.0;
  for (int i = 0; i < 6000; ++i) {
    people.step(step, in_door);
    for (const Walker& walker : people.walkers())
      least_m = std::min(least_m, (walker.disc.position_m - in_door.position_m).norm());
  }
  EXPECT_LT(least_m, apart_m) << "nobody came";
  EXPECT_GE(least_m, apart_m - options.gives_way_m - 1e-9);
}

TEST(Walkers, repeat_by_their_seed) {
  const auto end_of = [](std::uint64_t seed) {
    Walkers people(two_rooms(), {.count = 3}, robot, seed);
    for (int i = 0; i < 500; ++i) people.step(step, robot);
    return people.walkers().front().disc.position_m;
  };
  EXPECT_EQ(end_of(1), end_of(1));
  EXPECT_NE(end_of(1), end_of(2));
}

TEST(Walkers, give_way_to_who_comes_towards_them) {
  const Vec2 meets = social_force_mps2({0.0, 0.0}, {1.4, 0.0}, {2.0, 0.1}, {-1.4, 0.0});
  EXPECT_LT(meets.x(), 0.0) << "slower";
  EXPECT_LT(meets.y(), 0.0) << "to the right of who is on the left";
  const Vec2 far = social_force_mps2({0.0, 0.0}, {1.4, 0.0}, {20.0, 0.1}, {-1.4, 0.0});
  EXPECT_LT(far.norm(), 0.01 * meets.norm());
}

/// The least distance of one person of a kind from a robot that drives through the hall.
double nearest_m(PersonKind kind, std::uint64_t seed) {
  const PeopleOptions options{.count = 1,
                              .oblivious_share = kind == PersonKind::oblivious ? 1.0 : 0.0,
                              .threatening_share = kind == PersonKind::threatening ? 1.0 : 0.0};
  Walkers people(empty_floor(120, 120, 0.05), options, {{0.5, 3.0}, 0.0}, seed);
  double least_m = 100.0;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 driven{{0.5 + 0.005 * i, 3.0}, 0.0};
    people.step(step, driven);
    for (const Walker& walker : people.walkers())
      least_m = std::min(least_m, (walker.disc.position_m - driven.position_m).norm());
  }
  return least_m;
}

TEST(Walkers, who_threaten_come_nearer_than_who_keep_off) {
  double ordinary_m = 0.0;
  double threatening_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ordinary_m += nearest_m(PersonKind::ordinary, seed) / 20.0;
    threatening_m += nearest_m(PersonKind::threatening, seed) / 20.0;
  }
  EXPECT_GT(ordinary_m, threatening_m + 0.3);
}

TEST(Walkers, who_threaten_wait_until_the_robot_comes) {
  const PeopleOptions options{.count = 1, .oblivious_share = 0.0, .threatening_share = 1.0};
  Walkers people(two_rooms(), options, {{100.0, 100.0}, 0.0}, 1);
  for (int i = 0; i < 1000; ++i) people.step(step, {{100.0, 100.0}, 0.0});
  EXPECT_EQ(people.walkers().front().disc.walked_m, 0.0);
  const Vec2 waits_at_m = people.walkers().front().disc.position_m;
  for (int i = 0; i < 100; ++i) people.step(step, {waits_at_m + Vec2(2.5, 0.0), radians(180.0)});
  EXPECT_GT(people.walkers().front().disc.walked_m, 0.3);
}

/// Through doors of 0.8 m, one of them with the robot in it, for five minutes.
TEST(Walkers, who_walk_about_are_caught_at_no_wall) {
  OccupancyMap map = empty_floor(240, 160, 0.05);
  for (int row = 0; row < map.rows; ++row)
    if ((row < 32 || row >= 48) && (row < 112 || row >= 128))
      for (const int column : {118, 119, 120}) map.cells[map.index({column, row})] = OccupancyMap::occupied;
  const Pose2 in_door{{5.975, 2.0}, 0.0};
  int people_seen = 0;
  int caught = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Walkers people(map, {.count = 6, .threatening_share = 0.0, .robot_radius_m = 0.25}, in_door, seed);
    std::vector<double> moved_at_m(people.walkers().size());
    std::vector<int> stands(people.walkers().size());
    std::vector<int> longest(people.walkers().size());
    for (int i = 0; i < 30'000; ++i) {
      people.step(step, in_door);
      for (std::size_t k = 0; k < stands.size(); ++k) {
        const double walked_m = people.walkers()[k].disc.walked_m;
        if (walked_m > moved_at_m[k] + 0.1) {
          moved_at_m[k] = walked_m;
          stands[k] = 0;
        }
        longest[k] = std::max(longest[k], ++stands[k]);
      }
    }
    people_seen += static_cast<int>(longest.size());
    caught += static_cast<int>(std::ranges::count_if(longest, [](int steps) { return steps > 4500; }));
  }
  EXPECT_EQ(people_seen, 60);
  EXPECT_EQ(caught, 0) << "stood for 45 s, three times as long as they keep a goal";
}

}  // namespace
}  // namespace lodestar
