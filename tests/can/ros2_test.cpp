#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

#include "app/ros2/cdr.hpp"

#include "tests/can/lab.hpp"

// ROS 2 beside a robot on CAN: the localizer by itself while another program drives the base, and a drive by
// topic.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class Ros2 : public CanLab {
 protected:
  void SetUp() override {
    CanLab::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(shell("ip link set lo up"));
  }
};

TEST_F(Ros2, localizes_a_robot_that_another_drives_and_sends_nothing) {
  start_base();
  start_run("--localize-only --ros2 --ros-interface lo");
  ASSERT_TRUE(wait_for_words("the robot is at (", 30s)) << run->output();
  const std::string words = run->output();
  double x_m = 0.0;
  double y_m = 0.0;
  const std::string place = words.substr(words.find("the robot is at ("));
  ASSERT_EQ(std::sscanf(place.c_str(), "the robot is at (%lf, %lf", &x_m, &y_m), 2) << words;
  // The first fixes, by one marker that may be tilted by a degree, have a standard deviation of 6 mm.
  EXPECT_NEAR(x_m, 1.2, 0.015);
  EXPECT_NEAR(y_m, 5.6, 0.015);
  sleep_until(monotonic_now() + 1s);
  const auto is_sent_by_us = [](const CanFrame& frame) {
    return is_motion_command(frame) || agilex::decode_control_mode(frame).has_value();
  };
  EXPECT_TRUE(witness->heard(is_sent_by_us, Stamp{}).empty());

  Process other({LODESTAR_BINARY, "run", site, "--can", navigator_end, "--goal", "2.4,5.5"});
  EXPECT_EQ(other.wait(60s), 0);
  const std::string said = run->end();
  EXPECT_NE(said.find("at the end the robot is at (2.4"), std::string::npos) << said;
  EXPECT_NEAR(end_base().x_m, 2.4, 0.03);
}

/// geometry_msgs/PoseStamped in the map, as hexadecimal digits.
std::string goal_pose(double x_m, double y_m) {
  CdrBytes bytes;
  bytes.put(std::int32_t{0});  // stamp
  bytes.put(std::uint32_t{0});
  bytes.put("map");
  for (const double value : {x_m, y_m, 0.0, 0.0, 0.0, 0.0, 1.0}) bytes.put(value);
  std::string digits;
  for (const char byte : bytes.get()) digits += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return digits;
}

TEST_F(Ros2, drives_to_a_goal_by_topic) {
  if (!std::filesystem::exists(LODESTAR_FAST_PEER)) GTEST_SKIP() << "Fast DDS is not there";
  start_base();
  start_run("--ros2 --ros2-commands --ros-interface lo");
  EXPECT_TRUE(wait_for_words("base: ready", 30s)) << run->output();
  Process peer({LODESTAR_FAST_PEER, "0"});
  peer.say("write rt/goal_pose geometry_msgs::msg::dds_::PoseStamped_ " + goal_pose(2.4, 5.5));
  EXPECT_TRUE(wait_for_words("ros2: goal 1: arrived", 60s)) << run->output();
  run->say("stop");
  EXPECT_EQ(wait_for_the_end(20s), 0);
  EXPECT_NEAR(end_base().x_m, 2.4, 0.03);
}

}  // namespace
}  // namespace lodestar
