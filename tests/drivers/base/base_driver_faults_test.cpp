#include <gtest/gtest.h>

#include "drivers/base/base_driver.hpp"

#include "tests/drivers/base/base_driver_fixture.hpp"

// Faults that the driver latches, deviations that it tolerates, and when it resumes.
namespace lodestar {
namespace {

using namespace testing;
using agilex::ControlMode;
using agilex::VehicleState;
using std::chrono::milliseconds;

TEST_F(BaseDriverTest, latches_silence_within_100_ms_and_says_stop) {
  make_ready();
  base_silent = true;
  EXPECT_EQ(periods(5).state, BaseState::ready) << "feedback 100 ms old is still accepted";
  const BaseFeedback feedback = period();
  ASSERT_EQ(bus.sent.size(), 1U);
  EXPECT_EQ(bus.sent[0], agilex::encode_motion_command({}));
  expect_latched(BaseFault::feedback_lost, feedback);
  EXPECT_FALSE(driver.resume(now)) << "the base is still silent";
  base_silent = false;
  EXPECT_EQ(periods(50).state, BaseState::fault) << "a fault is latched until a resume";
}

TEST_F(BaseDriverTest, latches_when_one_kind_of_feedback_stays_away) {
  make_ready();
  base_silent = true;
  BaseFeedback feedback;
  for (int i = 0; i < 16; ++i) {
    now += milliseconds(20);
    hear(agilex::encode_system_state(system));
    ++system.counter;
    hear(agilex::encode_motion_state(measured));
    ASSERT_NE(feedback.state, BaseState::fault) << "feedback 300 ms old is still accepted";
    feedback = driver.poll(now);
  }
  EXPECT_EQ(feedback.details, "no odometer");
  expect_latched(BaseFault::feedback_incomplete, feedback);
}

TEST_F(BaseDriverTest, takes_a_counter_that_stands_still_for_a_base_that_hangs) {
  make_ready();
  counter_runs = false;
  EXPECT_EQ(periods(14).state, BaseState::ready);
  expect_latched(BaseFault::counter_stuck, periods(4));
  EXPECT_GE(driver.counts().counter_repeats, 15U);
}

TEST_F(BaseDriverTest, waits_for_a_base_whose_counter_stands_still_from_the_start) {
  counter_runs = false;
  period();
  system.mode = ControlMode::can;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(period().state, BaseState::waiting_for_base) << "period " << i;
  EXPECT_EQ(period().fault, BaseFault::counter_stuck) << "it is not silent";
  counter_runs = true;
  EXPECT_EQ(periods(2).state, BaseState::ready);
}

TEST_F(BaseDriverTest, names_what_a_base_does_not_send_from_the_start) {
  system.mode = ControlMode::can;
  BaseFeedback feedback;
  for (int i = 0; i < 20; ++i) {
    now += milliseconds(20);
    hear(agilex::encode_motion_state(measured));
    feedback = driver.poll(now);
  }
  EXPECT_EQ(feedback.state, BaseState::waiting_for_base);
  EXPECT_EQ(in_words(*feedback.fault, feedback.details),
            "the base does not send all of its feedback: no system state, no odometer");
}

TEST_F(BaseDriverTest, does_not_start_a_base_whose_state_comes_too_rarely) {
  system.mode = ControlMode::can;
  for (int i = 1; i < 200; ++i) {
    now += milliseconds(20);
    if (i % 40 == 0) base_speaks();
    hear(agilex::encode_motion_state(measured));
    hear(agilex::encode_odometer(odometer));
    const BaseFeedback feedback = driver.poll(now);
    if (i < 20) continue;
    ASSERT_EQ(feedback.state, BaseState::waiting_for_base) << "period " << i;
    ASSERT_EQ(in_words(*feedback.fault, feedback.details),
              "the base does not send all of its feedback: no system state");
  }
  EXPECT_NE(periods(15).state, BaseState::ready);
  EXPECT_EQ(periods(20).state, BaseState::ready) << "once it has come at its rate for 600 ms";
}

TEST_F(BaseDriverTest, asks_a_base_that_already_reports_a_fault_to_clear_it_when_told_to_resume) {
  system.mode = ControlMode::can;
  system.fault_bits = 0x0100;
  const BaseFeedback waiting = periods(50);
  EXPECT_EQ(waiting.state, BaseState::waiting_for_base);
  EXPECT_EQ(in_words(*waiting.fault, waiting.details), "the base reports fault bits: battery under-voltage");
  EXPECT_TRUE(bus.sent.empty()) << "nothing is cleared unasked";

  EXPECT_TRUE(driver.resume(now));
  ASSERT_EQ(bus.sent.size(), 1U);
  EXPECT_EQ(bus.sent[0], agilex::encode_clear_fault());
  EXPECT_EQ(period().state, BaseState::waiting_for_base) << "until the base reports that it has";
  system.fault_bits = 0;
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, cannot_resume_a_base_that_is_off) {
  base_silent = true;
  periods(10);
  EXPECT_FALSE(driver.resume(now));
  EXPECT_TRUE(bus.sent.empty());
}

TEST_F(BaseDriverTest, drives_with_its_transmitter_off_and_a_battery_that_is_getting_low) {
  system.fault_bits = 0x0600;
  make_ready();
  EXPECT_EQ(period().state, BaseState::ready);
  EXPECT_EQ(driver.warnings(),
            (std::vector<std::string>{"battery under-voltage warning", "remote control lost"}));
  system.fault_bits = 0x0700;
  const BaseFeedback feedback = period();
  EXPECT_EQ(feedback.details, "battery under-voltage");
  expect_latched(BaseFault::fault_bits, feedback);
  system.fault_bits = 0;
  EXPECT_EQ(period().details, "battery under-voltage") << "the first cause";
}

TEST_F(BaseDriverTest, leaves_a_base_that_somebody_took_over_alone) {
  make_ready();
  system.mode = ControlMode::remote;
  const BaseFeedback feedback = period();
  EXPECT_TRUE(bus.sent.empty()) << "neither a stop nor a request for CAN mode";
  expect_latched(BaseFault::left_can_mode, feedback);
  periods(50);
  EXPECT_TRUE(bus.sent.empty());
  EXPECT_FALSE(driver.resume(now)) << "the base is still in remote mode";

  system.mode = ControlMode::standby;
  EXPECT_EQ(periods(10).state, BaseState::fault);
  EXPECT_TRUE(driver.resume(now));
  EXPECT_EQ(period().state, BaseState::asking_for_can_mode);
  system.mode = ControlMode::can;
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, latches_an_emergency_stop_even_when_it_is_over_before_the_next_poll) {
  make_ready();
  system.vehicle = VehicleState::emergency_stop;
  base_speaks();
  system.vehicle = VehicleState::normal;
  expect_latched(BaseFault::emergency_stop, period());
}

TEST_F(BaseDriverTest, does_not_resume_before_the_cause_is_gone) {
  make_ready();
  system.vehicle = VehicleState::emergency_stop;
  expect_latched(BaseFault::emergency_stop, period());
  EXPECT_FALSE(driver.resume(now));
  EXPECT_EQ(period().state, BaseState::fault);
  system.vehicle = VehicleState::normal;
  EXPECT_EQ(period().state, BaseState::fault) << "a released button does not clear the fault";
  EXPECT_TRUE(driver.resume(now));
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, latches_exceptions_fault_bits_and_what_it_does_not_know) {
  const auto fault_after = [this](VehicleState vehicle, ControlMode mode, std::uint16_t bits) {
    BaseDriver fresh(bus);
    system = {VehicleState::normal, ControlMode::can, 26.0, 0, 0};
    base_speaks();
    EXPECT_EQ(fresh.poll(now).state, BaseState::ready);
    system.vehicle = vehicle;
    system.mode = mode;
    system.fault_bits = bits;
    base_speaks();
    return fresh.poll(now).fault;
  };
  EXPECT_EQ(fault_after(VehicleState::exception, ControlMode::can, 0), BaseFault::vehicle_exception);
  EXPECT_EQ(fault_after(VehicleState::unknown, ControlMode::can, 0), BaseFault::vehicle_exception);
  EXPECT_EQ(fault_after(VehicleState::normal, ControlMode::can, 0x8000), BaseFault::fault_bits);
  EXPECT_EQ(fault_after(VehicleState::normal, ControlMode::unknown, 0), BaseFault::left_can_mode);
  EXPECT_EQ(fault_after(VehicleState::normal, ControlMode::standby, 0), BaseFault::left_can_mode);
}

TEST_F(BaseDriverTest, gives_up_after_three_failed_sends_in_a_row) {
  make_ready();
  bus.takes_frames = false;
  driver.command({});
  driver.command({});
  bus.takes_frames = true;
  driver.command({});
  bus.takes_frames = false;
  driver.command({});
  driver.command({});
  EXPECT_EQ(period().state, BaseState::ready);
  driver.command({});
  bus.takes_frames = true;
  expect_latched(BaseFault::send_failed, period());
  EXPECT_GE(driver.counts().failed_sends, 5U);
  EXPECT_TRUE(driver.resume(now));
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, latches_a_base_that_runs_away) {
  make_ready();
  measured = {0.6, 0.0};
  for (int i = 0; i < 10; ++i) {
    driver.command({});
    EXPECT_EQ(period().state, BaseState::ready);
  }
  driver.command({});
  expect_latched(BaseFault::not_following, periods(2));
}

/// In a slow turn about one wheel, a stuck encoder of the other is a small error in speed, but one that
/// lasts.
TEST_F(BaseDriverTest, latches_a_wheel_that_stands_while_the_robot_creeps) {
  make_ready();
  measured = {0.0, 0.0};
  const int periods_until_fault = periods_until_not_following({0.12, -0.57});
  // 0.12 s until even the slowest base turns at 0.35 rad/s, and 1 s of tolerance.
  EXPECT_NEAR(periods_until_fault, 56, 2);
}

TEST_F(BaseDriverTest, bears_with_a_base_that_is_a_little_slow) {
  make_ready();
  measured = {0.4, 0.8};
  for (int i = 0; i < 200; ++i) {
    driver.command({0.5, 1.1});
    ASSERT_EQ(period().state, BaseState::ready);
  }
}

/// The controller of a robot that creeps turns against what a stuck encoder reports, until the other wheel
/// stands: it drove on a circle for five seconds (mission 1677 of the campaign).
TEST_F(BaseDriverTest, latches_a_base_that_creeps_and_does_not_turn_as_it_should) {
  make_ready();
  measured = {0.035, 0.0};
  const int periods_until_fault = periods_until_not_following({0.07, -0.33});
  // 0.07 s until even the slowest base turns at 0.2 rad/s, and 1.5 s of tolerance.
  EXPECT_NEAR(periods_until_fault, 79, 2);
}

TEST_F(BaseDriverTest, latches_a_base_that_ignores_its_commands) {
  make_ready();
  const int periods_until_fault = periods_until_not_following({0.6, 0.0});
  // 0.3 s until even the slowest base moves at 0.3 m/s, and 0.2 s of tolerance.
  EXPECT_NEAR(periods_until_fault, 25, 2);
}

TEST_F(BaseDriverTest, blames_no_base_for_a_pause_of_its_own) {
  make_ready();
  driver.command({0.6, 0.0});
  period();
  now += milliseconds(400);  // enough for even the slowest base to reach its speed
  base_speaks();
  EXPECT_EQ(driver.poll(now).state, BaseState::ready);
  driver.command({0.6, 0.0});
  EXPECT_EQ(period().state, BaseState::ready);
  measured = {0.5, 0.0};
  EXPECT_EQ(periods(40).state, BaseState::ready);
}

TEST_F(BaseDriverTest, latches_when_somebody_else_commands_the_base) {
  make_ready();
  hear(agilex::encode_motion_command({0.5, 0.0}));
  expect_latched(BaseFault::second_master, period());
}

TEST_F(BaseDriverTest, latches_what_becomes_of_the_bus_and_does_not_resume_before_it_is_well) {
  for (const auto& [state, fault] :
       {std::pair{BusState::stalled, BaseFault::bus_stalled},
        std::pair{BusState::bus_off, BaseFault::bus_off}, std::pair{BusState::down, BaseFault::bus_down},
        std::pair{BusState::missing, BaseFault::bus_missing},
        std::pair{BusState::guard_lost, BaseFault::guard_lost}}) {
    make_ready();
    bus.state = state;
    expect_latched(fault, period());
    EXPECT_FALSE(driver.resume(now));
    bus.state = BusState::up;
    expect_latched(fault, period());
    EXPECT_TRUE(driver.resume(now));
  }
}

TEST_F(BaseDriverTest, asks_a_guard_that_holds_back_to_let_go_only_on_resume) {
  make_ready();
  bus.state = BusState::held;
  expect_latched(BaseFault::guard_stopped, periods(10));
  EXPECT_EQ(bus.resumes, 0);
  EXPECT_TRUE(driver.resume(now));
  EXPECT_EQ(bus.resumes, 1);
  EXPECT_NE(period().state, BaseState::ready) << "the guard still controls the base";
  bus.state = BusState::up;
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, releases_a_base_that_somebody_else_has_taken) {
  make_ready();
  system.mode = ControlMode::remote;
  expect_latched(BaseFault::left_can_mode, period());
  EXPECT_EQ(bus.releases, 1) << "else the guard would send it stop commands";
}

TEST_F(BaseDriverTest, gives_a_base_one_more_period_after_a_pause_of_its_own) {
  make_ready();
  now += milliseconds(300);
  EXPECT_EQ(driver.poll(now).state, BaseState::ready);
  now += milliseconds(20);
  expect_latched(BaseFault::feedback_lost, driver.poll(now));
}

}  // namespace
}  // namespace lodestar
