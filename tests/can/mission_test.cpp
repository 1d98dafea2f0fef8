#include <cmath>
#include <optional>

#include "app/recording/run_origin.hpp"
#include "drivers/can/candump.hpp"
#include "drivers/system/clock.hpp"

#include "tests/can/lab.hpp"

// Whole missions by the command line over a real kernel's CAN.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

constexpr Duration start_up = 20s;  ///< of a program on a busy machine

class Mission : public CanLab {};

std::vector<CanFrame> motion_commands(const std::vector<LoggedCanFrame>& log) {
  std::vector<CanFrame> commands;
  for (const LoggedCanFrame& line : log) {
    if (is_motion_command(line.received.frame)) commands.push_back(line.received.frame);
  }
  return commands;
}

TEST_F(Mission, arrives_and_candump_saw_it) {
  Process candump({"sh", "-c", "exec candump -L " + base_end + " >candump.log"});
  start_base();
  start_run("--goal 2.4,5.5 --goal 2.2,5.6,90 -o run");
  EXPECT_EQ(wait_for_the_end(60s), 0);
  const Truth truth = end_base();
  // A program that is told to end leaves unread what is still in its socket: it has time to write that down.
  const auto commands = witness->heard(is_motion_command, Stamp{});
  const Stamp give_up = monotonic_now() + 10s;
  while (motion_commands(load_candump("candump.log")).size() < commands.size() && monotonic_now() < give_up) {
    sleep_until(monotonic_now() + 50ms);
  }
  candump.end();

  EXPECT_NEAR(truth.x_m, 2.2, 0.03);
  EXPECT_NEAR(truth.y_m, 5.6, 0.03);
  EXPECT_NEAR(truth.heading_deg, 90.0, 2.0);
  EXPECT_EQ(truth.contacts, 0);

  // The log of another program: CAN mode is requested before the first command, and the last command is zero.
  const std::vector<LoggedCanFrame> log = load_candump("candump.log");
  bool asked = false;
  for (const LoggedCanFrame& line : log) {
    asked = asked || agilex::decode_control_mode(line.received.frame) == agilex::ControlMode::can;
    ASSERT_TRUE(asked || !is_motion_command(line.received.frame));
  }
  const std::vector<CanFrame> logged = motion_commands(log);
  ASSERT_GT(logged.size(), 300U);
  EXPECT_TRUE(is_zero_command(logged.back()));

  // At most 1 % of the commands come later than two periods of 20 ms and 25 ms for this kernel.
  EXPECT_EQ(commands.size(), logged.size());
  std::size_t late = 0;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    if (is_zero_command(commands[i - 1].frame)) continue;
    if (commands[i].stamp - commands[i - 1].stamp > 65ms) ++late;
  }
  EXPECT_LE(late, commands.size() / 100);
  EXPECT_FALSE(load_candump("run/can.log").empty());
  const std::optional<Duration> clock_offset = read_run_origin("run").value().clock_offset;
  ASSERT_TRUE(clock_offset);
  EXPECT_NEAR(seconds(*clock_offset - system_clock_offset()), 0.0, 1.0);
}

/// A full disk must not affect the drive; that the run is not recorded as a whole shows in the exit code.
TEST_F(Mission, a_full_disk_ends_the_log_and_not_the_drive) {
  ASSERT_TRUE(shell("mkdir -p /run/small && mount -t tmpfs -o size=16k tmpfs /run/small"));
  start_base();
  start_run("--goal 2.4,5.5 -o /run/small/run");
  EXPECT_EQ(wait_for_the_end(40s), 1);
  EXPECT_TRUE(wait_for_words("goal 1: arrived", 1s));
  EXPECT_TRUE(wait_for_words("the run is not recorded as a whole", 1s));
  EXPECT_NEAR(end_base().x_m, 2.4, 0.03);
  ASSERT_TRUE(shell("umount /run/small"));
}

/// The same drive on the two axes of an ODrive.
TEST_F(Mission, arrives_with_an_odrive) {
  ASSERT_TRUE(shell(
      "cp -r " LODESTAR_SOURCE_DIR
      "/sites/lab odrive && sed -i 's/^base:.*/base: {bus: socketcan:vcan0, "
      "protocol: odrive, wheel_diameter_m: 0.17, left_node: 0, right_node: 1, right_is_mirrored: true}/' "
      "odrive/site.yaml"));
  site = "odrive";
  start_base("--protocol odrive");
  start_run("--goal 2.4,5.5");
  EXPECT_EQ(wait_for_the_end(40s), 0);
  const Truth truth = end_base();
  EXPECT_NEAR(truth.x_m, 2.4, 0.03);
  EXPECT_NEAR(truth.y_m, 5.5, 0.03);
}

/// After a run nobody commands the axes: their watchdog expires, and the next run finds them with an error.
TEST_F(Mission, drives_an_odrive_again_whose_watchdog_expired_after_the_run_before) {
  ASSERT_TRUE(shell(
      "cp -r " LODESTAR_SOURCE_DIR
      "/sites/lab watched && sed -i 's/^base:.*/base: {bus: socketcan:vcan0, "
      "protocol: odrive, wheel_diameter_m: 0.17, left_node: 0, right_node: 1, right_is_mirrored: true}/' "
      "watched/site.yaml"));
  site = "watched";
  start_base("--protocol odrive --watchdog 0.5");
  start_run("--goal 1.5,5.6");
  EXPECT_EQ(wait_for_the_end(40s), 0);
  sleep_until(monotonic_now() + 1s);
  start_run("--goal 1.8,5.6");
  EXPECT_TRUE(wait_for_words("the base reports fault bits: watchdog expired", start_up)) << run->output();
  EXPECT_TRUE(wait_for_words("resume asks it to clear that", 1s)) << run->output();
  run->say("resume");
  EXPECT_EQ(wait_for_the_end(40s), 0);
  EXPECT_NEAR(end_base().x_m, 1.8, 0.03);
}

/// The frames that third-party clients expect, each at its period.
TEST_F(Mission, base_speaks_as_the_manual_says) {
  start_base();
  const auto first = witness->wait_for([](const CanFrame& frame) { return frame.id == 0x211; }, Stamp{}, 10s);
  ASSERT_TRUE(first);
  sleep_until(first->stamp + 2500ms);
  for (const auto& [id, expected] : {std::pair{0x211U, 100.0},
                                     {0x221U, 100.0},
                                     {0x311U, 100.0},
                                     {0x251U, 100.0},
                                     {0x252U, 100.0},
                                     {0x261U, 20.0},
                                     {0x262U, 20.0},
                                     {0x361U, 4.0}}) {
    const auto heard = witness->heard([id = id](const CanFrame& frame) { return frame.id == id; },
                                      first->stamp, first->stamp + 2000ms);
    EXPECT_NEAR(static_cast<double>(heard.size()), expected, 1.0 + 0.2 * expected) << std::hex << id;
  }
}

TEST_F(Mission, waits_for_an_interface_and_a_base_that_come_later) {
  ASSERT_TRUE(shell("ip link del vcan0"));
  start_run("--goal 1.8,5.6");
  EXPECT_TRUE(wait_for_words("missing", start_up));
  ASSERT_TRUE(shell("ip link add dev vcan0 type vcan && ip link set vcan0 up"));
  EXPECT_TRUE(wait_for_words("silent", start_up));
  const auto commands = witness->heard(is_motion_command, Stamp{});
  EXPECT_TRUE(commands.empty()) << "motion commanded without a base: " << candump_line(commands.front());
  start_base();
  EXPECT_EQ(wait_for_the_end(30s), 0);
}

TEST_F(Mission, is_refused_with_a_camera_that_is_not_there) {
  ASSERT_TRUE(shell("cp -r " LODESTAR_SOURCE_DIR
                    "/sites/lab filmed && sed -i 's|^camera:.*|camera: v4l2:/dev/video9|' filmed/site.yaml"));
  site = "filmed";
  start_base();
  start_run("--goal 1.8,5.6");
  EXPECT_EQ(run->wait(start_up), 2);
  EXPECT_TRUE(wait_for_words("/dev/video9: found a device that cannot be opened", 1s));
  EXPECT_TRUE(witness->heard(is_motion_command, Stamp{}).empty());
}

TEST_F(Mission, without_a_base_ends_in_failure) {
  start_run("--goal 1.8,5.6");
  EXPECT_EQ(run->wait(60s), 1);
  EXPECT_TRUE(wait_for_words("the base is silent", 1s));
}

}  // namespace
}  // namespace lodestar
