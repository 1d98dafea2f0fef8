#include "tests/can/machine_clock.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr MachineClockOptions four_times{.host_seconds_a_second = 4, .longest_step = 10 * ms};

TEST(MachineClock, GoesAsFastAsItsHostWorks) {
  MachineClock clock(1000 * ms, four_times);
  EXPECT_EQ(clock.look(1008 * ms), 1002 * ms);
  EXPECT_EQ(clock.look(1012 * ms), 1003 * ms);
}

TEST(MachineClock, DoesNotCountWhatTheHostDidElse) {
  MachineClock clock(0, four_times);
  EXPECT_EQ(clock.look(5000 * ms), 10 * ms / 4);
  EXPECT_EQ(clock.look(5004 * ms), 10 * ms / 4 + 1 * ms);
}

TEST(MachineClock, NeverGoesBackAndNeverStands) {
  MachineClock clock(7 * ms, four_times);
  EXPECT_EQ(clock.look(3 * ms), 7 * ms + 1);
  EXPECT_EQ(clock.look(3 * ms), 7 * ms + 2);
}

TEST(MachineClock, DoesNotPassAnInterruptThatWasNotTaken) {
  MachineClock clock(0, four_times);
  clock.arm(2 * ms, 0);
  EXPECT_EQ(clock.host_time_until_due(), 8 * ms);
  clock.look(4 * ms);
  EXPECT_FALSE(clock.take_interrupt());
  EXPECT_EQ(clock.host_time_until_due(), 4 * ms);
  EXPECT_EQ(clock.look(13 * ms), 2 * ms);
  EXPECT_EQ(clock.look(22 * ms), 2 * ms + 1) << "each read advances the clock";
  EXPECT_TRUE(clock.take_interrupt());
  EXPECT_FALSE(clock.take_interrupt()) << "the interrupt is taken once";
  EXPECT_EQ(clock.until_due(), std::nullopt);
}

TEST(MachineClock, InterruptsEachPeriod) {
  MachineClock clock(0, four_times);
  clock.arm(3 * ms, 10 * ms);
  clock.leap_to_due();
  EXPECT_TRUE(clock.take_interrupt());
  EXPECT_EQ(clock.until_due(), 10 * ms);
  clock.disarm();
  clock.leap_to_due();
  EXPECT_FALSE(clock.take_interrupt());
}

TEST(MachineClock, LeapsWhenThereIsNothingToDo) {
  MachineClock clock(0, four_times);
  clock.arm(3600'000 * ms, 0);
  clock.leap_to_due();
  EXPECT_EQ(clock.look(0), 3600'000 * ms + 1);
  EXPECT_TRUE(clock.take_interrupt());
}

}  // namespace
}  // namespace lodestar
