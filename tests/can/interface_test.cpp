#include <fstream>

#include "tests/can/lab.hpp"

// Faults of the CAN interface itself: each is latched, and the mission continues after an explicit resume.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

constexpr Duration one_period = 20ms;  ///< between two frames of the base

class Interface : public CanLab {
 protected:
  void drive(const std::string& goal = "2.4,5.5") {
    start_base();
    start_run("--goal " + goal);
    wait_until_driving();
  }

  /// Stamp of the last frame received on an interface that has since been removed.
  Stamp last_frame() const { return witness->last(is_anything).value_or(Stamp{}); }

  /// The robot stays stopped until an operator resumes, and then arrives.
  void expect_latched_until_resume(const std::string& words, Stamp back) {
    EXPECT_TRUE(wait_for_words(words, 2s));
    EXPECT_FALSE(witness->wait_for(is_moving_command, back, 1s)) << "motion commanded without a resume";
    EXPECT_EQ(resume_and_wait_for_the_end(40s), 0);
    const Truth truth = end_base();
    EXPECT_NEAR(truth.x_m, 2.4, 0.03);
    EXPECT_NEAR(truth.y_m, 5.5, 0.03);
  }
};

TEST_F(Interface, switched_off_for_300_ms) {
  drive();
  ASSERT_TRUE(shell("ip link set vcan0 down"));
  const Stamp off = last_frame();
  expect_said_within(one_period + 20ms, "the CAN interface is switched off", off);
  sleep_until(monotonic_now() + 300ms);
  const Stamp back = monotonic_now();
  ASSERT_TRUE(shell("ip link set vcan0 up"));
  measure("interface switched off for 300 ms", off);
  expect_latched_until_resume("switched off", back);
}

TEST_F(Interface, removed_and_plugged_in_again) {
  drive();
  ASSERT_TRUE(shell("ip link del vcan0"));
  const Stamp off = last_frame();
  constexpr Duration removal = 60ms;  // the kernel takes several ticks to remove a device
  expect_said_within(one_period + 20ms + removal, "base: stopped by a fault", off);
  sleep_until(monotonic_now() + 500ms);
  const Stamp back = monotonic_now();
  ASSERT_TRUE(shell("ip link add dev vcan0 type vcan && ip link set vcan0 txqueuelen 10 up"));
  measure("interface removed for 500 ms", off);
  expect_latched_until_resume("base: stopped by a fault", back);
}

TEST_F(Interface, bus_off_until_the_controller_restarts) {
  drive();
  ASSERT_TRUE(shell("cansend vcan0 20000040#0000000000000000"));
  EXPECT_TRUE(wait_for_words("bus-off", 5s));
  const auto off = witness->last_error();
  ASSERT_TRUE(off);
  expect_said_within(one_period + 20ms, "bus-off", *off - one_period);
  EXPECT_TRUE(witness->wait_for(is_zero_command, *off - one_period, 1s));
  measure("bus-off", *off);
  run->say("resume");
  EXPECT_TRUE(wait_for_words("cannot resume", 1s));
  const Stamp back = monotonic_now();
  ASSERT_TRUE(shell("cansend vcan0 20000100#0000000000000000"));
  expect_latched_until_resume("bus-off", back);
}

/// As an error frame that a bad cable forged: a controller that is off the bus would receive nothing.
TEST_F(Interface, bus_off_that_is_contradicted_by_frames_is_dropped) {
  drive();
  ASSERT_TRUE(shell("cansend vcan0 20000040#0000000000000000"));
  const Stamp forged = monotonic_now();  // the shell may take its time on a busy machine
  expect_latched_until_resume("bus-off", forged + 200ms);
}

TEST_F(Interface, error_passive_makes_it_slow) {
  drive("4.2,5.5");
  const Stamp passive = monotonic_now();
  std::ofstream("passive.log") << "(1.000000) vcan0 20000204#0020000000008080\n"
                               << "(1.200000) vcan0 20000204#0020000000008080\n";
  Process words({"canplayer", "-I", "passive.log", "-l", "i"});
  EXPECT_TRUE(witness->wait_for(drives_faster_than(0.1), passive + 1s, 3s));
  EXPECT_TRUE(witness->heard(drives_faster_than(0.35), passive + 1s).empty());
  words.end();
  EXPECT_EQ(wait_for_the_end(40s), 0);
  EXPECT_EQ(run->output().find("CAN controller"), std::string::npos) << "a warning was reported as a fault";
}

}  // namespace
}  // namespace lodestar
