#include "localization/scan/deskewed.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestar {
namespace {

constexpr double track_width_m = 0.4;
const ScannerMount mount{.base_from_scanner = {{0.15, 0.02}, 0.3}, .height_m = 0.2};
const OwnOutline own{.shape = RobotShape(0.25)};

Stamp at(double s) {
  return Stamp(from_seconds(s));
}

/// Driving an arc at a constant velocity from the origin, as it is in truth.
Pose2 truth(const BodyVelocity& velocity, double s) {
  const double yaw_rad = velocity.turn_radps * s;
  const double radius_m = velocity.forward_mps / velocity.turn_radps;
  return {radius_m * Vec2(std::sin(yaw_rad), 1.0 - std::cos(yaw_rad)), yaw_rad};
}

WheelTrack track_of(const BodyVelocity& velocity, double until_s) {
  WheelTrack track({.track_width_m = track_width_m});
  for (double s = 0.0; s <= until_s + 1e-9; s += 0.02) {
    const double aside_m = 0.5 * track_width_m * velocity.turn_radps * s;
    track.add({at(s), velocity.forward_mps * s - aside_m, velocity.forward_mps * s + aside_m});
  }
  return track;
}

TEST(WheelTrack, FollowsAnArcExactlyBetweenItsReadings) {
  const BodyVelocity velocity{0.5, 1.0};
  const WheelTrack track = track_of(velocity, 1.0);
  for (const double s : {0.0, 0.033, 0.5, 0.999, 1.05}) {
    const std::optional<Pose2> pose = track.pose_at(at(s));
    ASSERT_TRUE(pose) << s;
    EXPECT_NEAR((pose->position_m - truth(velocity, s).position_m).norm(), 0.0, 1e-6) << s;
    EXPECT_NEAR(pose->yaw_rad, truth(velocity, s).yaw_rad, 1e-6) << s;
  }
  EXPECT_NEAR(track.velocity().forward_mps, 0.5, 1e-6);
}

TEST(WheelTrack, KnowsNothingBeyondItsReadings) {
  const WheelTrack track = track_of({0.5, 1.0}, 3.0);
  EXPECT_TRUE(track.pose_at(at(3.06)));
  EXPECT_FALSE(track.pose_at(at(3.07)));
  EXPECT_FALSE(track.pose_at(at(0.9)));  // 2 s are kept
  EXPECT_FALSE(WheelTrack().pose_at(at(0.0)));
}

TEST(WheelTrack, ScalesTheWheelsFromThenOn) {
  WheelTrack track({.track_width_m = 0.5});
  track.add({at(0.0), 3.0, 4.0});
  track.add({at(0.1), 3.1, 4.1});
  track.use_scales({.left = 1.05, .right = 0.95, .turn = 1.02});
  EXPECT_NEAR(track.pose_at(at(0.1))->yaw_rad, 0.0, 1e-12);
  track.add({at(0.2), 3.2, 4.2});
  EXPECT_NEAR(track.pose_at(at(0.2))->yaw_rad, 1.02 * (0.095 - 0.105) / 0.5, 1e-12);
}

TEST(WheelTrack, CutsScalesThatNoWheelHas) {
  WheelTrack track({.track_width_m = 0.5, .most_scale_change = 0.1});
  track.add({at(0.0), 0.0, 0.0});
  track.use_scales({.left = 3.0, .right = 3.0});
  track.add({at(0.1), 0.1, 0.1});
  EXPECT_NEAR(track.pose_at(at(0.1))->position_m.x(), 0.11, 1e-12);
}

/// A wall along x = 3 of the odometry frame, seen for 0.1 s while driving and turning at 1 rad/s.
TEST(Deskewed, AWallIsStraightWhileTheRobotTurns) {
  const BodyVelocity velocity{0.5, 1.0};
  Scan scan{.beams = {}, .min_range_m = 0.1, .max_range_m = 12.0};
  for (int i = 0; i < 100; ++i) {
    const double s = 0.5 + 0.001 * i;
    const double angle_rad = -1.5 + 0.015 * i;
    const Pose2 odom_from_scanner = truth(velocity, s) * mount.base_from_scanner;
    const double range_m =
        (3.0 - odom_from_scanner.position_m.x()) / std::cos(odom_from_scanner.yaw_rad + angle_rad);
    scan.beams.push_back({at(s), angle_rad, range_m, 1.0F, Echo::hit});
  }
  const std::optional<std::vector<Pose2>> poses = poses_during(scan, track_of(velocity, 0.6));
  ASSERT_TRUE(poses);
  const DeskewedScan still = deskewed(scan, mount, *poses, own, OwnParts());
  ASSERT_EQ(still.rays.size(), 100U);
  for (const Ray& ray : still.rays) EXPECT_NEAR(ray.end_m.x(), 3.0, 0.001);
  EXPECT_EQ(still.newest, at(0.599));
  EXPECT_FALSE(poses_during(scan, track_of(velocity, 0.5)));  // the wheels are silent
  EXPECT_FALSE(poses_during({}, track_of(velocity, 0.6)));
}

TEST(Deskewed, LeavesOutTheRobotItselfAndNothingElse) {
  Scan scan{.beams = {}, .min_range_m = 0.3, .max_range_m = 12.0};
  const double back_rad = std::numbers::pi - 0.3;                    // across the whole robot
  scan.beams.push_back({at(0.0), back_rad, 0.40, 1.0F, Echo::hit});  // its own edge
  scan.beams.push_back({at(0.0), back_rad, 0.45, 1.0F, Echo::hit});  // a foot beside it
  scan.beams.push_back({at(0.0), -0.3, 0.15, 1.0F, Echo::hit});      // nearer than min_range_m, outside
  scan.beams.push_back({at(0.0), -0.3, 0.0, 0.0F, Echo::too_near});  // outside at 0.3 m
  scan.beams.push_back({at(0.0), -0.3, 0.0, 0.0F, Echo::nothing});
  OwnParts parts;
  for (int i = 0; i < 10; ++i) parts.add(scan, mount, own);
  const std::vector<Pose2> poses = poses_during(scan, track_of({0.5, 1.0}, 0.1)).value();
  const DeskewedScan seen = deskewed(scan, mount, poses, own, parts);
  ASSERT_EQ(seen.rays.size(), 4U);
  EXPECT_NEAR((seen.rays[0].end_m - Vec2(-0.30, 0.02)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((seen.rays[2].end_m - Vec2(0.45, 0.02)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((seen.rays[3].end_m - seen.rays[3].origin_m).norm(), 12.0, 1e-9);
}

/// Within the outline, but where the robot has no part of its own; and where a part has been taken off.
TEST(Deskewed, KeepsWhoTouchesTheRobot) {
  const double back_rad = std::numbers::pi - 0.3;
  const Beam post{at(0.0), back_rad, 0.30, 1.0F, Echo::hit};
  const Beam leg{at(0.0), 0.5, 0.05, 1.0F, Echo::hit};
  const auto scan_of = [](std::vector<Beam> beams) {
    return Scan{.beams = std::move(beams), .min_range_m = 0.02, .max_range_m = 12.0};
  };
  const auto count = [&](const Scan& scan, const OwnParts& parts) {
    const std::vector<Pose2> poses = poses_during(scan, track_of({0.5, 1.0}, 0.1)).value();
    return deskewed(scan, mount, poses, own, parts).rays.size();
  };
  OwnParts parts;
  EXPECT_EQ(count(scan_of({post}), parts), 1U) << "before it has learned, everything is somebody";
  for (int i = 0; i < 10; ++i) parts.add(scan_of({post}), mount, own);
  EXPECT_EQ(count(scan_of({post}), parts), 0U);
  EXPECT_EQ(count(scan_of({post, leg}), parts), 1U);
  for (int i = 0; i < 30; ++i) parts.add(scan_of({post, leg}), mount, own);
  EXPECT_EQ(count(scan_of({post, leg}), parts), 1U) << "however long it stays";
  for (int i = 0; i < 5; ++i) parts.add(scan_of({}), mount, own);
  EXPECT_EQ(count(scan_of({post}), parts), 1U);
}

}  // namespace
}  // namespace lodestar
