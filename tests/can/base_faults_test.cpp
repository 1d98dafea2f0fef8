#include <cmath>
#include <csignal>

#include "tests/can/lab.hpp"

// Faults of the base, interventions of people, and other nodes on the bus.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

bool says_emergency_stop(const CanFrame& frame) {
  const auto state = agilex::decode_system_state(frame);
  return state && state->vehicle == VehicleState::emergency_stop;
}

bool says_remote(const CanFrame& frame) {
  const auto state = agilex::decode_system_state(frame);
  return state && state->mode == ControlMode::remote;
}

bool says_fault_bits(const CanFrame& frame) {
  const auto state = agilex::decode_system_state(frame);
  return state && state->fault_bits != 0;
}

class BaseFaults : public CanLab {
 protected:
  void drive(const std::string& fault = "", const std::string& goal = "4.2,5.5") {
    start_base(fault.empty() ? "" : "--fault " + fault);
    start_run("--goal " + goal);
  }

  /// Time since which the base reports a speed that differs from the command by more than 0.3 m/s, until the
  /// navigator's zero command.
  std::optional<Stamp> strays_from_commands() const {
    constexpr double counts_mps = 0.3;
    std::optional<Stamp> since;
    double commanded_mps = 0.0;
    bool has_moved = false;
    for (const StampedCanFrame& heard : witness->heard([](const CanFrame&) { return true; }, Stamp{})) {
      if (const auto command = agilex::decode_motion_command(heard.frame)) {
        if (has_moved && since && is_zero_command(heard.frame)) break;
        commanded_mps = command->forward_mps;
        has_moved = has_moved || commanded_mps > counts_mps;
      } else if (const auto state = agilex::decode_motion_state(heard.frame)) {
        const bool strays = std::abs(state->forward_mps - commanded_mps) > counts_mps;
        if (!strays) since.reset();
        if (strays && !since) since = heard.stamp;
      }
    }
    return since;
  }

  /// The last odometer frame in which the left wheel's count changed.
  std::optional<StampedCanFrame> left_wheel_last_counted() const {
    std::optional<StampedCanFrame> last;
    std::optional<agilex::Odometer> before;
    for (const StampedCanFrame& heard : witness->heard([](const CanFrame&) { return true; }, Stamp{})) {
      const auto odometer = agilex::decode_odometer(heard.frame);
      if (!odometer) continue;
      if (before && odometer->left_mm != before->left_mm) last = heard;
      before = odometer;
    }
    return last;
  }
};

TEST_F(BaseFaults, an_emergency_stop_is_latched_and_not_ended_by_its_release) {
  drive("estop@1+0.5", "2.4,5.5");
  const auto pressed = witness->wait_for(says_emergency_stop, Stamp{}, 20s);
  ASSERT_TRUE(pressed);
  expect_no_motion_after(40ms, pressed->stamp);
  expect_said_within(40ms, "the emergency stop is pressed", pressed->stamp);
  measure("emergency stop", pressed->stamp);
  const auto released = witness->wait_for(
      [](const CanFrame& frame) { return agilex::decode_system_state(frame) && !says_emergency_stop(frame); },
      pressed->stamp, 5s);
  ASSERT_TRUE(released);
  EXPECT_FALSE(witness->wait_for(is_moving_command, released->stamp, 1s))
      << "motion commanded without a resume";
  EXPECT_EQ(resume_and_wait_for_the_end(40s), 0);
}

TEST_F(BaseFaults, the_remote_control_is_not_fought) {
  drive("remote@1.5+1");
  const auto taken = witness->wait_for(says_remote, Stamp{}, 20s);
  ASSERT_TRUE(taken);
  sleep_until(taken->stamp + 900ms);
  const auto commands = witness->heard(is_motion_command, taken->stamp);
  if (!commands.empty()) expect_within(40ms, taken->stamp, commands.back().stamp, "the last command");
  const Stamp silent = monotonic_now();
  expect_said_within(40ms, "not in CAN mode", taken->stamp);
  measure("remote control takes over", taken->stamp);
  run->signal(SIGKILL);
  sleep_until(monotonic_now() + 300ms);
  EXPECT_TRUE(witness->heard(is_motion_command, silent).empty())
      << "the navigator or the guard still sends commands";
}

TEST_F(BaseFaults, a_fault_bit_stops) {
  drive("fault-bits@1.5");
  const auto seen = witness->wait_for(says_fault_bits, Stamp{}, 20s);
  ASSERT_TRUE(seen);
  expect_no_motion_after(40ms, seen->stamp);
  measure("fault bit", seen->stamp);
}

TEST_F(BaseFaults, a_silent_base_is_noticed_within_100_ms) {
  drive("silent@1.5");
  ASSERT_TRUE(wait_for_words("base: stopped by a fault (the base is silent)", 20s));
  const auto heard =
      witness->heard([](const CanFrame& frame) { return frame.id == agilex::motion_state_id; }, Stamp{});
  const auto moving = witness->heard(is_moving_command, Stamp{});
  ASSERT_FALSE(heard.empty());
  ASSERT_FALSE(moving.empty());
  expect_within(120ms, heard.back().stamp, moving.back().stamp, "the last moving command");
  const auto zero = witness->wait_for(is_zero_command, moving.back().stamp, 1s);
  ASSERT_TRUE(zero) << "no zero command";
  expect_within(40ms, moving.back().stamp, zero->stamp, "the zero command");
  EXPECT_TRUE(witness->heard(is_moving_command, zero->stamp).empty());
  measure("base silent", heard.back().stamp);
}

TEST_F(BaseFaults, a_base_that_ignores_its_commands_is_noticed) {
  drive("ignores@1.5");
  ASSERT_TRUE(wait_for_words("the base does not follow its commands", 20s));
  const auto strays = strays_from_commands();
  ASSERT_TRUE(strays);
  expect_said_within(250ms, "the base does not follow its commands", *strays);
  measure("base ignores commands", *strays);
}

TEST_F(BaseFaults, a_runaway_base_is_noticed) {
  drive("runaway@1.5+1");
  ASSERT_TRUE(wait_for_words("the base does not follow its commands", 20s));
  const auto strays = strays_from_commands();
  ASSERT_TRUE(strays);
  expect_said_within(250ms, "the base does not follow its commands", *strays);
  measure("base runs away", *strays);
}

/// The wheel turns but its count does not change: odometry shows a curve that nobody commanded, and marker
/// fixes contradict it. Where the fixes reveal it first, the robot brakes and tries again from their pose,
/// twice at most.
TEST_F(BaseFaults, a_stuck_encoder_ends_the_drive_within_60_cm) {
  drive("stuck-encoder@1.5");
  ASSERT_TRUE(wait_for_any_words({"base: stopped by a fault", "the wheels cannot be believed"}, 20s));
  const auto last_true = left_wheel_last_counted();
  ASSERT_TRUE(last_true);
  measure("encoder stuck", last_true->stamp);
  expect_no_motion_after(0ms, monotonic_now());
  const auto odometer = agilex::decode_odometer(last_true->frame);
  const Truth truth = end_base();
  EXPECT_LT(truth.driven_m - (odometer->left_mm + odometer->right_mm) / 2e3, 0.6);
  EXPECT_EQ(truth.contacts, 0);
}

/// Marker fixes override odometry.
TEST_F(BaseFaults, slipping_wheels_are_driven_through) {
  drive("slip@1+2");
  EXPECT_EQ(wait_for_the_end(40s), 0);
  const Truth truth = end_base();
  EXPECT_NEAR(truth.x_m, 4.2, 0.04);
  EXPECT_NEAR(truth.y_m, 5.5, 0.04);
  EXPECT_EQ(truth.contacts, 0);
}

TEST_F(BaseFaults, a_robot_that_is_carried_away_stops_within_300_ms_and_for_good) {
  drive("kidnap@1.5");
  EXPECT_EQ(run->wait(40s), 1);
  EXPECT_TRUE(wait_for_words("not where it was believed to be", 1s)) << run->output();
  const auto moved_first = witness->wait_for(is_moving_command, Stamp{}, 1s);
  ASSERT_TRUE(moved_first);
  expect_no_motion_after(300ms, moved_first->stamp + 1500ms);
}

TEST_F(BaseFaults, a_second_master_is_noticed_within_40_ms) {
  drive();
  wait_until_driving();
  const Stamp before = monotonic_now();
  ASSERT_TRUE(shell("cansend vcan0 111#0123000000000000"));
  const auto foreign = witness->wait_for(
      [](const CanFrame& frame) { return frame.id == agilex::motion_command_id && frame.data[1] == 0x23; },
      before, 1s);
  ASSERT_TRUE(foreign);
  expect_no_motion_after(40ms, foreign->stamp);
  EXPECT_TRUE(wait_for_words("somebody else sends motion commands", 1s));
  measure("second master", foreign->stamp);
}

TEST_F(BaseFaults, odd_frames_and_a_flood_of_others_do_nothing) {
  drive("", "2.4,5.5");
  wait_until_driving();
  ASSERT_TRUE(
      shell("for f in 211#00 211# 221#01 311#0102030405 241#FFFFFFFFFFFFFFFF 7FF#00 20000004#00 211##1FF "
            "00000211#0101010101010101 211#R; do cansend vcan0 $f; done 2>/dev/null; true"));
  Process flood({"cangen", "vcan0", "-g", "1", "-I", "5AA", "-L", "8"});
  EXPECT_EQ(wait_for_the_end(40s), 0);
  EXPECT_FALSE(wait_for_words("fault", 0s)) << run->output();
}

}  // namespace
}  // namespace lodestar
