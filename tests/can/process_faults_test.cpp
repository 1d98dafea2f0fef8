#include <csignal>

#include "tests/can/lab.hpp"

// The driving processes die or hang; the base comes to rest.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class ProcessFaults : public CanLab {
 protected:
  void drive() {
    start_base();
    start_run("--goal 9.0,5.2");
    wait_until_driving();
  }

  void expect_rest(Stamp since) {
    EXPECT_TRUE(witness->wait_for(says_standing, since + 300ms, 3s)) << "the base never came to rest";
  }

  pid_t guard_of_run() const {
    FILE* const found = popen(("pgrep -P " + std::to_string(run->id())).c_str(), "r");
    int id = -1;
    if (std::fscanf(found, "%d", &id) != 1) id = -1;
    pclose(found);
    return id;
  }
};

TEST_F(ProcessFaults, a_killed_navigator_is_stopped_within_50_ms) {
  drive();
  const Stamp killed = monotonic_now();
  run->signal(SIGKILL);
  const auto zero = witness->wait_for(is_zero_command, killed, 2s);
  ASSERT_TRUE(zero);
  expect_within(50ms, killed, zero->stamp, "the zero command");
  EXPECT_TRUE(witness->heard(is_moving_command, zero->stamp).empty());
  expect_rest(killed);
  measure("navigator killed", killed);
}

TEST_F(ProcessFaults, a_hung_navigator_is_stopped_within_150_ms_and_stays_stopped_when_it_wakes) {
  drive();
  const Stamp hung = monotonic_now();
  run->signal(SIGSTOP);
  const auto zero = witness->wait_for(is_zero_command, hung, 2s);
  ASSERT_TRUE(zero);
  expect_within(150ms, hung, zero->stamp, "the zero command");
  expect_rest(hung);
  measure("navigator hung", hung);

  const Stamp woken = monotonic_now();
  run->signal(SIGCONT);
  EXPECT_TRUE(wait_for_words("the guard has stopped a navigator that hung", 2s));
  EXPECT_FALSE(witness->wait_for(is_moving_command, zero->stamp, 1s)) << "motion commanded without a resume";
  EXPECT_GT(monotonic_now() - woken, 900ms);

  run->say("resume");
  EXPECT_TRUE(witness->wait_for(drives_faster_than(0.2), woken, 5s));
}

TEST_F(ProcessFaults, a_killed_guard_leaves_the_base_to_its_own_timeout) {
  drive();
  const pid_t guard = guard_of_run();
  ASSERT_GT(guard, 0);
  const Stamp killed = monotonic_now();
  ASSERT_EQ(kill(guard, SIGKILL), 0);
  EXPECT_EQ(run->wait(10s), 1);
  const auto commands = witness->heard(is_motion_command, killed);
  if (!commands.empty()) expect_within(0ms, killed, commands.back().stamp, "the last command of anybody");
  EXPECT_TRUE(witness->wait_for(says_standing, killed, 2s));
  measure("guard killed", killed);
}

TEST_F(ProcessFaults, with_both_killed_the_base_comes_to_rest_by_itself) {
  drive();
  const pid_t guard = guard_of_run();
  ASSERT_GT(guard, 0);
  const Stamp killed = monotonic_now();
  ASSERT_EQ(kill(guard, SIGKILL), 0);
  run->signal(SIGKILL);
  const auto rest = witness->wait_for(says_standing, killed, 3s);
  ASSERT_TRUE(rest);
  // 500 ms for the base's command timeout, 300 ms to brake from 0.6 m/s at 2 m/s2, its lag and a period.
  expect_within(1200ms, killed, rest->stamp, "rest");
  measure("navigator and guard killed", killed);
}

/// The guard runs with real-time priority (SCHED_FIFO).
TEST_F(ProcessFaults, the_guard_of_a_hung_navigator_is_not_starved_by_eight_busy_programs) {
  drive();
  std::vector<std::unique_ptr<Process>> hogs;
  const Stamp busy = monotonic_now();
  for (int i = 0; i < 8; ++i) {
    hogs.push_back(std::make_unique<Process>(std::vector<std::string>{"sh", "-c", "while :; do :; done"}));
  }
  run->signal(SIGSTOP);
  const auto zero = witness->wait_for(is_zero_command, busy, 5s);
  hogs.clear();
  ASSERT_TRUE(zero);
  const auto moved = witness->heard(is_moving_command, Stamp{}, zero->stamp);
  ASSERT_FALSE(moved.empty());
  expect_within(150ms, moved.back().stamp, zero->stamp, "the zero command");
  expect_rest(zero->stamp);
}

TEST_F(ProcessFaults, an_hour_on_the_wall_clock_is_no_fault) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  ASSERT_TRUE(shell("date -s '+1 hour' >/dev/null"));
  wait_for_words("never said", 500ms);
  ASSERT_TRUE(shell("date -s '-2 hours' >/dev/null"));
  EXPECT_EQ(wait_for_the_end(30s), 0);
  EXPECT_FALSE(wait_for_words("fault", 0s)) << run->output();
}

}  // namespace
}  // namespace lodestar
