#include "tests/can/lab.hpp"

// The localizer by itself, beside another program that drives the base.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class LocalizeOnly : public CanLab {
 protected:
  void SetUp() override {
    CanLab::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(shell("ip link set lo up"));
  }
};

TEST_F(LocalizeOnly, follows_a_robot_that_another_drives_and_sends_nothing) {
  start_base();
  start_run("--localize-only --ros2 --ros-interface lo");
  EXPECT_TRUE(wait_for_words("the robot is at (1.20, 5.60", 30s)) << run->output();
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

}  // namespace
}  // namespace lodestar
