#include "control/corner.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "control/rotate_then_drive.hpp"

#include "tests/control/plant.hpp"

namespace lodestar {
namespace {

DriveOptions blending(double corridor_m) {
  DriveOptions options;
  options.blend_corridor_m = corridor_m;
  return options;
}

Vec2 ahead(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

TEST(Corner, touches_both_legs_and_stays_in_its_corridor) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double in_heading = random.uniform(-3.1, 3.1);
    const double turn = random.uniform(-1.0, 1.0);
    const Vec2 waypoint(1.0, -2.0);
    const Vec2 before = waypoint - random.uniform(0.3, 3.0) * ahead(in_heading);
    const Vec2 after = waypoint + random.uniform(0.3, 3.0) * ahead(in_heading + turn);
    const std::optional<Corner> corner = corner_at(before, waypoint, after, blending(0.05));
    ASSERT_TRUE(corner) << turn;
    EXPECT_NEAR(corner->turn_rad, turn, 1e-9);
    const Vec2 begin = waypoint - corner->cut_m * ahead(in_heading);
    const Vec2 end = waypoint + corner->cut_m * ahead(in_heading + turn);
    EXPECT_NEAR((begin - corner->center_m).norm(), corner->radius_m, 1e-9);
    EXPECT_NEAR((end - corner->center_m).norm(), corner->radius_m, 1e-9);
    EXPECT_LE((waypoint - corner->center_m).norm() - corner->radius_m, 0.05 + 1e-9);
    EXPECT_LE(corner->cut_m, 0.4 * std::min((waypoint - before).norm(), (after - waypoint).norm()) + 1e-9);
    EXPECT_NEAR(on_corner(*corner, begin).turned_rad, 0.0, 1e-9);
    EXPECT_NEAR(on_corner(*corner, end).turned_rad, std::abs(turn), 1e-9);
    const Vec2 left(-std::sin(in_heading), std::cos(in_heading));
    EXPECT_NEAR(on_corner(*corner, begin + 0.01 * left).beside_m, 0.01, 1e-6);
  }
}

TEST(Corner, is_none_where_the_robot_must_stop) {
  const Vec2 before(0.0, 0.0);
  const Vec2 waypoint(1.0, 0.0);
  EXPECT_FALSE(corner_at(before, waypoint, {1.5, 0.1}, {})) << "corner blending is off";
  EXPECT_FALSE(corner_at(before, waypoint, {1.0, 1.0}, blending(0.05))) << "too sharp";
  EXPECT_FALSE(corner_at(before, waypoint, waypoint, blending(0.05)));
  EXPECT_FALSE(corner_at(before, waypoint, {2.0, 0.0}, blending(0.05))) << "no change of direction";
}

struct Drive {
  bool arrived = false;
  double time_s = 0.0;
  double farthest_m = 0.0;
  double slowest_mps = 1.0;  ///< from the first metre to the last
  double most_wheel_mps = 0.0;
  Vec2 end;
};

Drive drive(const Path& path, const DriveOptions& options, std::uint64_t seed) {
  RotateThenDrive controller(path, std::nullopt, options);
  const Vec2 first = path.waypoints_m[1] - path.waypoints_m[0];
  Plant plant{.truth = {path.waypoints_m.front(), std::atan2(first.y(), first.x())}};
  plant.random = Random(seed);
  Drive result;
  for (int step = 0; step < 5000 && !controller.arrived(); ++step) {
    const BodyVelocity command = controller.update(plant.sensed(), from_seconds(period_s));
    const WheelSpeeds wheels = wheel_speeds(command, 0.4);
    result.most_wheel_mps = std::max({result.most_wheel_mps, wheels.left_mps, wheels.right_mps});
    plant.run(command);
    result.time_s += period_s;
    result.farthest_m = std::max(result.farthest_m, distance_to_path_m(path, plant.truth.position_m));
    const bool between = (plant.truth.position_m - path.waypoints_m.front()).norm() > 0.9 &&
                         (plant.truth.position_m - path.waypoints_m.back()).norm() > 0.9;
    if (between) result.slowest_mps = std::min(result.slowest_mps, command.forward_mps);
  }
  result.arrived = controller.arrived();
  result.end = plant.truth.position_m;
  return result;
}

TEST(Corner, is_passed_without_stopping_and_sooner) {
  Random random(9);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Path path{{Vec2::Zero(), Vec2(1.5, 0.0)}};
    double heading = 0.0;
    for (int leg = 0; leg < 3; ++leg) {
      heading += random.uniform(radians(8.0), radians(40.0)) * (random.below(2) == 0 ? 1.0 : -1.0);
      path.waypoints_m.push_back(path.waypoints_m.back() + random.uniform(1.0, 2.0) * ahead(heading));
    }
    const Drive stopping = drive(path, {}, seed);
    const Drive passing = drive(path, blending(0.05), seed);
    ASSERT_TRUE(stopping.arrived && passing.arrived) << "seed " << seed;
    EXPECT_LT(passing.farthest_m, 0.05 + 0.02) << "seed " << seed;
    EXPECT_GT(passing.slowest_mps, 0.1) << "seed " << seed;
    EXPECT_LT(stopping.slowest_mps, 0.01) << "seed " << seed;
    EXPECT_LT(passing.time_s, stopping.time_s - 3.0) << "seed " << seed;
    EXPECT_LE(passing.most_wheel_mps, 0.8 + 0.05) << "seed " << seed;
    EXPECT_LT((passing.end - path.waypoints_m.back()).norm(), 0.015) << "seed " << seed;
  }
}

}  // namespace
}  // namespace lodestar
