#include "app/navigation/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

#include "drivers/simulation/simulated_scanner.hpp"

// What a robot makes of what stands around it while it stands in the middle of a hall.
namespace lodestar {
namespace {

/// Walls around, and two posts of 10 cm a metre before the robot, as of a doorway.
OccupancyMap hall() {
  OccupancyMap map{.columns = 120, .rows = 120, .resolution_m = 0.05};
  map.cells.assign(120UL * 120UL, OccupancyMap::free);
  const auto is_wall = [&](int column, int row) {
    return column < 2 || row < 2 || column >= map.columns - 2 || row >= map.rows - 2;
  };
  const auto is_post = [](int column, int row) {
    return (column == 80 || column == 81) && (row == 50 || row == 51 || row == 70 || row == 71);
  };
  for (int column = 0; column < map.columns; ++column)
    for (int row = 0; row < map.rows; ++row)
      if (is_wall(column, row) || is_post(column, row))
        map.cells[map.index({column, row})] = OccupancyMap::occupied;
  return map;
}

std::ptrdiff_t count_beyond(double beyond_m, const Vec2& middle_m, const std::vector<Vec2>& points_m) {
  return std::ranges::count_if(points_m,
                               [&](const Vec2& point_m) { return (point_m - middle_m).norm() > beyond_m; });
}

class SurroundingsTest : public ::testing::Test {
 protected:
  void stand(double for_s, const std::vector<DiscState>& discs) {
    const Stamp end = now_ + from_seconds(for_s);
    for (; now_ < end; now_ += std::chrono::milliseconds(20)) {
      scanner_.observe(now_, robot_, discs);
      std::vector<Scan> scans;
      while (std::optional<Scan> scan = scanner_.poll()) scans.push_back(std::move(*scan));
      const WheelTravel travel{.stamp = now_};
      surroundings_.add({&travel, 1}, scans, {}, now_, mapped());
    }
  }

  [[nodiscard]] MappedPose mapped() const {
    PoseEstimate estimate{.stamp = now_, .map_from_base = robot_};
    estimate.covariance = Vec3(1e-6, 1e-6, 1e-6).asDiagonal();
    return {field_, estimate};
  }

  [[nodiscard]] std::vector<Vec2> unmapped_m() const {
    return surroundings_.unmapped(now_, mapped(), {}).roomy_m;
  }

  /// Somebody of 25 cm who talks there: for the field they walk.
  void sway_at(const Vec2& place_m) {
    for (int i = 0; i < 80; ++i) {
      const Vec2 swayed_m = place_m + 0.06 * Vec2(std::sin(1.3 * i), std::cos(2.1 * i));
      stand(0.5, {{.radius_m = 0.25, .position_m = swayed_m}});
    }
  }

  Pose2 robot_{{3.0, 3.0}, 0.0};
  ObstacleField field_{hall()};
  SimulatedScanner scanner_{field_.map(), {}, 1};
  Surroundings surroundings_{{}};
  Stamp now_ = Stamp{} + std::chrono::milliseconds(20);
};

TEST_F(SurroundingsTest, plans_around_a_chair_for_the_body_on_its_legs) {
  const DiscState chair{.radius_m = 0.25, .has_legs = true, .position_m = {3.0, 4.2}};
  stand(15.0, {chair});
  const std::vector<Vec2> around_m = unmapped_m();
  ASSERT_FALSE(around_m.empty());
  for (const Vec2& point_m : around_m) EXPECT_LT((point_m - chair.position_m).norm(), 0.6);
}

/// A post may carry a seat that no beam meets; where no way has the room for one, it is passed as it is seen.
TEST_F(SurroundingsTest, plans_around_a_post_for_what_it_may_carry_where_there_is_room) {
  const DiscState post{.radius_m = 0.03, .position_m = {3.0, 4.2}};  // so thin that it hides no leg behind it
  stand(5.0, {post});
  const UnmappedObstacles around = surroundings_.unmapped(now_, mapped(), {});
  EXPECT_GT(count_beyond(0.25, post.position_m, around.roomy_m), 10);
  ASSERT_FALSE(around.tight_m.empty());
  EXPECT_EQ(count_beyond(0.1, post.position_m, around.tight_m), 0);
}

/// Who has come without legs that can be seen may go for a minute; what stays is a thing, and passed closely.
TEST_F(SurroundingsTest, keeps_clear_of_what_has_come_for_a_minute) {
  const auto farthest_m = [&](const DiscState& disc) {
    double farthest = 0.0;
    for (const Vec2& point_m : unmapped_m())
      farthest = std::max(farthest, (point_m - disc.position_m).norm() - disc.radius_m);
    return farthest;
  };
  stand(5.0, {});
  const DiscState visitor{.radius_m = 0.25, .position_m = {3.0, 4.2}};
  stand(30.0, {visitor});
  EXPECT_GT(farthest_m(visitor), 0.2);
  stand(45.0, {visitor});
  EXPECT_GT(farthest_m(visitor), 0.0);
  EXPECT_LT(farthest_m(visitor), 0.1);
}

/// Nobody may move within a metre of who walks, and people who talk sway: a robot that drove up to them stood
/// there for as long as they did. Where no other way leads, it waits for them all the same.
TEST_F(SurroundingsTest, plans_far_around_someone_who_sways) {
  const Vec2 place_m(3.0, 5.0);
  sway_at(place_m);
  const UnmappedObstacles around = surroundings_.unmapped(now_, mapped(), {});
  EXPECT_GT(count_beyond(1.2, place_m, around.roomy_m), 10);
  EXPECT_EQ(count_beyond(0.6, place_m, around.tight_m), 0);
  for (const Vec2& point_m : around.roomy_m) EXPECT_GT((point_m - robot_.position_m).norm(), 0.5);
}

/// Else no way with room led to a goal near them, and the one without led past everybody else as closely.
TEST_F(SurroundingsTest, leaves_room_at_a_goal_near_someone_who_sways) {
  const Vec2 place_m(3.0, 5.0);
  const Goal goal{.position_m = place_m + Vec2(1.0, 0.0)};
  sway_at(place_m);
  const UnmappedObstacles around = surroundings_.unmapped(now_, mapped(), {&goal, 1});
  for (const Vec2& point_m : around.roomy_m) EXPECT_GT((point_m - goal.position_m).norm(), 0.3);
  EXPECT_GT(count_beyond(0.6, place_m, around.roomy_m), 10);
}

/// The field forbids to pass who may walk off at once within 0.57 m: a path that kept the 0.28 m of what
/// stands held the robot for as long as they stayed.
TEST_F(SurroundingsTest, plans_around_someone_who_has_come_to_stay_and_holds_the_robot) {
  const DiscState visitor{.radius_m = 0.25, .position_m = {3.75, 3.2}};
  stand(5.0, {});
  const auto want_to_pass = [&](double for_s) {
    for (int i = 0; i < static_cast<int>(for_s / 0.1); ++i) {
      stand(0.1, {visitor});
      surroundings_.allowed(now_, BodyVelocity{}, {0.02, 0.0});
    }
  };
  want_to_pass(20.0);
  EXPECT_EQ(count_beyond(0.6, visitor.position_m, unmapped_m()), 0);
  want_to_pass(20.0);
  const UnmappedObstacles around = surroundings_.unmapped(now_, mapped(), {});
  EXPECT_GT(count_beyond(0.6, visitor.position_m, around.roomy_m), 5);
  EXPECT_EQ(count_beyond(0.6, visitor.position_m, around.tight_m), 0);
}

/// Mission 80042 stood for two minutes before a doorway whose posts it took for someone's legs.
TEST_F(SurroundingsTest, takes_no_posts_of_the_map_for_legs) {
  stand(15.0, {});
  for (const Vec2& point_m : unmapped_m()) ADD_FAILURE() << point_m.transpose();
}

/// The controller begins with a centimetre a second, and again in each step that the field ends at zero.
TEST_F(SurroundingsTest, says_why_it_holds_a_robot_that_only_begins_to_move) {
  stand(2.0, {});
  stand(0.5, {{.radius_m = 0.25, .position_m = {3.9, 3.0}}});
  const Surroundings::Allowed allowed = surroundings_.allowed(now_, BodyVelocity{}, {0.01, 0.0});
  EXPECT_EQ(allowed.velocity.forward_mps, 0.0);
  EXPECT_EQ(allowed.reason, StopReason::person_near);
}

/// The map explains it, as it is 4 cm beside a post, and a path along the map leads past it for ever.
TEST_F(SurroundingsTest, finds_in_the_way_what_has_held_it_though_the_map_explains_it) {
  const DiscState frame{.radius_m = 0.04, .position_m = {4.05, 3.5}};
  robot_.position_m = frame.position_m - 0.298 * Vec2(0.54, 0.84).normalized();
  const Path past{{robot_.position_m, robot_.position_m + Vec2(1.0, 0.0)}};
  const Path away{{robot_.position_m, robot_.position_m - Vec2(0.5, 1.0)}};
  stand(2.0, {});  // what touches it from the beginning is its own
  stand(3.0, {frame});
  EXPECT_FALSE(surroundings_.obstacles_in_the_way(now_, mapped(), past, {}));
  int held = 0;
  for (int i = 0; i < 50; ++i) {
    stand(0.1, {frame});
    const Surroundings::Allowed allowed = surroundings_.allowed(now_, BodyVelocity{}, {0.01, 0.0});
    held += allowed.reason ? 1 : 0;
  }
  EXPECT_GT(held, 30) << "but for the noise of the range";
  EXPECT_FALSE(surroundings_.obstacles_in_the_way(now_, mapped(), away, {}));
  stand(0.1, {frame});
  const auto found = surroundings_.obstacles_in_the_way(now_, mapped(), past, {});
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->roomy_m.size(), 1U);
  EXPECT_NEAR((found->roomy_m.front() - frame.position_m).norm(), frame.radius_m, 0.02);
}

TEST_F(SurroundingsTest, says_whether_a_way_that_has_lost_room_can_be_followed_on) {
  const Path ahead{{robot_.position_m, robot_.position_m + Vec2(2.0, 0.0)}};
  const auto beside = [&](double distance_m) {
    return DiscState{.radius_m = 0.15, .position_m = robot_.position_m + Vec2(1.0, 0.15 + distance_m)};
  };
  const auto in_the_way = [&] { return surroundings_.obstacles_in_the_way(now_, mapped(), ahead, {}); };
  stand(3.0, {beside(0.28)});
  EXPECT_TRUE(in_the_way().value().path_is_passable);
  stand(0.5, {});
  stand(30.0, {beside(0.22)});
  EXPECT_FALSE(in_the_way().value().path_is_passable);
}

}  // namespace
}  // namespace lodestar
