#include "app/ros2/ros2_session.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr double track_width_m = 0.4;

/// The odometry of a robot that another program drives along arcs, forward, backward and on the spot.
std::vector<OdometryReading> driven() {
  std::vector<OdometryReading> readings;
  Pose2 odom_from_base{{3.0, -1.0}, 2.0};
  for (int i = 0; i < 400; ++i) {
    readings.push_back({Stamp(std::chrono::milliseconds(20 * i)), odom_from_base});
    const double forward_m = i < 150 ? 0.012 : i < 250 ? -0.008 : i < 300 ? 0.0 : 0.02;
    const double half_rad = 0.5 * (i < 300 ? 0.03 * std::sin(0.05 * i) : -0.01);
    const double chord_m = std::abs(half_rad) < 1e-9 ? forward_m : forward_m * std::sin(half_rad) / half_rad;
    odom_from_base =
        odom_from_base * Pose2{{chord_m * std::cos(half_rad), chord_m * std::sin(half_rad)}, 2.0 * half_rad};
  }
  return readings;
}

TEST(OdometryOfOthers, comes_to_wheels_that_roll_the_same_way) {
  Ros2Link link;
  Ros2Session session(link, {.reads_odometry = true}, track_width_m);
  const std::vector<OdometryReading> readings = driven();
  WheelTrack track({.track_width_m = track_width_m});
  std::size_t count = 0;
  for (const OdometryReading& reading : readings) {
    link.give(reading);
    for (const WheelTravel& travel : session.wheel_travel()) {
      track.add(travel);
      ++count;
    }
    const auto rolled = track.pose_at(reading.stamp);
    ASSERT_TRUE(rolled);
    const Pose2 expected = inverse(readings.front().odom_from_base) * reading.odom_from_base;
    EXPECT_NEAR((rolled->position_m - expected.position_m).norm(), 0.0, 1e-9);
    EXPECT_NEAR(wrap_angle(rolled->yaw_rad - expected.yaw_rad), 0.0, 1e-9);
  }
  EXPECT_EQ(count, readings.size());
}

TEST(OdometryOfOthers, that_goes_back_in_time_is_passed_over) {
  Ros2Link link;
  Ros2Session session(link, {.reads_odometry = true}, track_width_m);
  for (const OdometryReading& reading : driven()) link.give(reading);
  (void)session.wheel_travel();
  link.give({Stamp(std::chrono::milliseconds(100)), Pose2{}});
  EXPECT_TRUE(session.wheel_travel().empty());
}

TEST(Ros2LinkTest, keeps_the_newest_reports_and_the_first_commands) {
  Ros2Link link;
  for (int i = 0; i < 100; ++i) link.publish({.now = Stamp(std::chrono::milliseconds(i))});
  const std::vector<Ros2Report> reports = link.take_reports();
  ASSERT_EQ(reports.size(), 64U);
  EXPECT_EQ(reports.back().now, Stamp(std::chrono::milliseconds(99)));
  EXPECT_TRUE(link.take_reports().empty());

  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += link.give(Ros2Goal{}) ? 1 : 0;
  EXPECT_EQ(taken, 16);
  EXPECT_EQ(link.take_commands().size(), 16U);
  EXPECT_TRUE(link.give(Ros2Goal{}));
}

}  // namespace
}  // namespace lodestar
