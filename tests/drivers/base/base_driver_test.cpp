#include "drivers/base/base_driver.hpp"

#include <cmath>
#include <deque>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "maps/random.hpp"

namespace lodestar {
namespace {

using agilex::ControlMode;
using agilex::VehicleState;
using std::chrono::milliseconds;

/// The far end of the bus in the hands of the test.
class ScriptedBus final : public CanBus {
 public:
  bool send(const CanFrame& frame) override {
    if (!takes_frames) return false;
    sent.push_back(frame);
    return true;
  }
  std::optional<StampedCanFrame> poll() override {
    if (arriving.empty()) return std::nullopt;
    const StampedCanFrame frame = arriving.front();
    arriving.pop_front();
    return frame;
  }

  [[nodiscard]] BusHealth health() const override { return {state, {}}; }
  void resume() override { ++resumes; }
  void release() override { ++releases; }

  bool takes_frames = true;
  BusState state = BusState::up;
  int resumes = 0;
  int releases = 0;
  std::vector<CanFrame> sent;
  std::deque<StampedCanFrame> arriving;
};

/// A driver, and a base that says every 20 ms what the test wants it to say.
class BaseDriverTest : public testing::Test {
 protected:
  void hear(const CanFrame& frame) { bus.arriving.push_back({now, frame}); }

  void base_speaks() {
    if (!base_silent) {
      hear(agilex::encode_system_state(system));
      if (counter_runs) ++system.counter;
      hear(agilex::encode_motion_state(measured));
      hear(agilex::encode_odometer(odometer));
    }
  }

  BaseFeedback period() {
    now += milliseconds(20);
    base_speaks();
    return driver.poll(now);
  }

  BaseFeedback periods(int count) {
    BaseFeedback feedback;
    for (int i = 0; i < count; ++i) feedback = period();
    return feedback;
  }

  void make_ready() {
    system.mode = ControlMode::can;
    ASSERT_EQ(period().state, BaseState::ready);
    bus.sent.clear();
  }

  void expect_latched(BaseFault fault, const BaseFeedback& feedback) {
    EXPECT_EQ(feedback.state, BaseState::fault);
    EXPECT_EQ(feedback.fault, fault) << to_string(feedback.fault.value_or(BaseFault::send_failed));
    bus.sent.clear();
    driver.command({0.5, 0.0});
    EXPECT_TRUE(bus.sent.empty()) << "drives in spite of the fault";
  }

  ScriptedBus bus;
  BaseDriver driver{bus};
  Stamp now;
  agilex::SystemState system;
  BodyVelocity measured;
  agilex::Odometer odometer;
  bool base_silent = false;
  bool counter_runs = true;
};

TEST_F(BaseDriverTest, waits_in_silence_for_a_base_that_is_off) {
  base_silent = true;
  const BaseFeedback feedback = periods(100);
  EXPECT_EQ(feedback.state, BaseState::waiting_for_base);
  EXPECT_EQ(feedback.fault, BaseFault::feedback_lost);
  EXPECT_FALSE(feedback.last_heard);
  driver.command({0.5, 0.0});
  EXPECT_TRUE(bus.sent.empty());
}

TEST_F(BaseDriverTest, asks_for_can_mode_every_100_ms_until_it_is_granted) {
  EXPECT_EQ(periods(26).state, BaseState::asking_for_can_mode);  // 20 ms .. 520 ms
  EXPECT_EQ(bus.sent.size(), 6U);
  for (const CanFrame& frame : bus.sent) EXPECT_EQ(frame, (CanFrame{0x421, 1, {1}}));
  driver.command({0.5, 0.0});
  EXPECT_EQ(bus.sent.size(), 6U) << "no motion command before the base is ready";

  system.mode = ControlMode::can;
  EXPECT_EQ(period().state, BaseState::ready);
  driver.command({0.15, 0.0});
  EXPECT_EQ(bus.sent.back(), (CanFrame{0x111, 8, {0x00, 0x96}}));
}

TEST_F(BaseDriverTest, waits_while_the_base_is_not_fit_and_says_why) {
  system.mode = ControlMode::can;
  system.vehicle = VehicleState::emergency_stop;
  EXPECT_EQ(period().fault, BaseFault::emergency_stop);
  system.vehicle = VehicleState::normal;
  system.fault_bits = 0x0004;
  const BaseFeedback feedback = period();
  EXPECT_EQ(feedback.state, BaseState::waiting_for_base);
  EXPECT_EQ(feedback.fault, BaseFault::fault_bits);
  EXPECT_EQ(feedback.system->fault_bits, 0x0004);
  system.fault_bits = 0;
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, may_be_told_to_ignore_fault_bits) {
  BaseDriver lenient(bus, {.ignored_fault_bits = 0x0004});
  system.mode = ControlMode::can;
  system.fault_bits = 0x0004;
  base_speaks();
  EXPECT_EQ(lenient.poll(now).state, BaseState::ready);
  system.fault_bits = 0x0005;
  base_speaks();
  EXPECT_EQ(lenient.poll(now).fault, BaseFault::fault_bits);
}

TEST_F(BaseDriverTest, needs_to_hear_the_motion_of_the_base_too) {
  system.mode = ControlMode::can;
  hear(agilex::encode_system_state(system));
  EXPECT_EQ(driver.poll(now).state, BaseState::waiting_for_base);
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, unwraps_the_odometer_both_ways) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
  odometer = {most - 5, least + 5};
  const BaseFeedback first = period();
  ASSERT_EQ(first.travel.size(), 1U);
  EXPECT_EQ(first.travel[0].left_m, 0.0) << "travel counts from the first reading";
  odometer = {least + 4, most - 4};
  const BaseFeedback second = period();
  ASSERT_EQ(second.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(second.travel[0].left_m, 0.010);
  EXPECT_DOUBLE_EQ(second.travel[0].right_m, -0.010);
  EXPECT_EQ(second.travel[0].stamp, now);
  EXPECT_EQ(driver.counts().odd_frames, 0U);
}

TEST_F(BaseDriverTest, gives_all_readings_since_the_last_poll_oldest_first) {
  for (int i = 1; i <= 3; ++i) {
    now += milliseconds(20);
    odometer.left_mm = 10 * i;
    base_speaks();
  }
  const BaseFeedback feedback = driver.poll(now);
  ASSERT_EQ(feedback.travel.size(), 3U);
  EXPECT_DOUBLE_EQ(feedback.travel[2].left_m, 0.020);
  EXPECT_EQ(feedback.travel[1].stamp - feedback.travel[0].stamp, Duration(milliseconds(20)));
  EXPECT_TRUE(driver.poll(now).travel.empty());
}

TEST_F(BaseDriverTest, takes_no_leap_when_the_base_restarts_its_odometer) {
  odometer = {123'456, 123'456};
  period();
  odometer = {0, 0};
  EXPECT_TRUE(period().travel.empty());
  EXPECT_EQ(driver.counts().odd_frames, 1U);
  odometer = {10, 20};
  const BaseFeedback feedback = period();
  ASSERT_EQ(feedback.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(feedback.travel[0].left_m, 0.010);
}

TEST_F(BaseDriverTest, loses_no_travel_by_a_broken_reading) {
  period();
  odometer = {10 + (1 << 20), 10};
  EXPECT_TRUE(period().travel.empty());
  odometer = {20, 20};
  const BaseFeedback feedback = period();
  ASSERT_EQ(feedback.travel.size(), 1U);
  EXPECT_DOUBLE_EQ(feedback.travel[0].left_m, 0.020);
  EXPECT_DOUBLE_EQ(feedback.travel[0].right_m, 0.020);
  EXPECT_EQ(driver.counts().odd_frames, 1U);
}

TEST_F(BaseDriverTest, does_not_believe_a_reading_from_the_past) {
  period();
  odometer = {10, 10};
  bus.arriving.push_back({now - milliseconds(1), agilex::encode_odometer(odometer)});
  EXPECT_TRUE(driver.poll(now).travel.empty());
  EXPECT_EQ(driver.counts().odd_frames, 1U);
}

TEST_F(BaseDriverTest, latches_silence_within_100_ms_and_says_stop) {
  make_ready();
  base_silent = true;
  EXPECT_EQ(periods(5).state, BaseState::ready) << "100 ms old is not too old yet";
  const BaseFeedback feedback = period();
  ASSERT_EQ(bus.sent.size(), 1U);
  EXPECT_EQ(bus.sent[0], agilex::encode_motion_command({}));
  expect_latched(BaseFault::feedback_lost, feedback);
  EXPECT_FALSE(driver.resume(now)) << "nobody is there to resume";
  base_silent = false;
  EXPECT_EQ(periods(50).state, BaseState::fault) << "a fault stays until somebody resumes";
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
    ASSERT_NE(feedback.state, BaseState::fault) << "at 300 ms it may still come";
    feedback = driver.poll(now);
  }
  expect_latched(BaseFault::feedback_lost, feedback);
}

TEST_F(BaseDriverTest, takes_a_counter_that_stands_still_for_silence) {
  make_ready();
  counter_runs = false;
  EXPECT_EQ(periods(14).state, BaseState::ready);
  expect_latched(BaseFault::feedback_lost, periods(4));
  EXPECT_GE(driver.counts().counter_repeats, 15U);
}

TEST_F(BaseDriverTest, counts_missing_system_states) {
  make_ready();
  system.counter = static_cast<std::uint8_t>(system.counter + 3);
  EXPECT_EQ(period().state, BaseState::ready);
  EXPECT_EQ(driver.counts().counter_jumps, 1U);
  EXPECT_EQ(periods(300).state, BaseState::ready);
  EXPECT_EQ(driver.counts().counter_jumps, 1U) << "wrapping around is no jump";
}

TEST_F(BaseDriverTest, leaves_a_base_that_somebody_took_over_alone) {
  make_ready();
  system.mode = ControlMode::remote;
  const BaseFeedback feedback = period();
  EXPECT_TRUE(bus.sent.empty()) << "neither a stop nor a request for CAN mode";
  expect_latched(BaseFault::left_can_mode, feedback);
  periods(50);
  EXPECT_TRUE(bus.sent.empty());
  EXPECT_FALSE(driver.resume(now)) << "while the remote control has it";

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
  EXPECT_EQ(period().state, BaseState::fault) << "releasing the button moves nothing";
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

TEST_F(BaseDriverTest, keeps_the_curve_of_a_command_that_is_too_fast) {
  make_ready();
  driver.command({2.0, 1.0});
  EXPECT_EQ(bus.sent.back(), agilex::encode_motion_command({1.0, 0.5}));
  driver.command({0.5, -4.0});
  EXPECT_EQ(bus.sent.back(), agilex::encode_motion_command({0.25, -2.0}));
  EXPECT_EQ(driver.saturated_commands(), 2U);
  driver.command({1.0, -2.0});
  EXPECT_EQ(driver.saturated_commands(), 2U) << "at the limit is not beyond it";
}

TEST_F(BaseDriverTest, sends_zero_for_a_velocity_that_is_not_finite) {
  make_ready();
  driver.command({std::nan(""), 0.5});
  driver.command({0.5, std::numeric_limits<double>::infinity()});
  ASSERT_EQ(bus.sent.size(), 2U);
  for (const CanFrame& frame : bus.sent) EXPECT_EQ(frame, agilex::encode_motion_command({}));
  EXPECT_EQ(driver.counts().non_finite_commands, 2U);
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

/// Turning slowly about a wheel that stands still, as an encoder that is stuck has it, is no more than a
/// small error; but it does not pass.
TEST_F(BaseDriverTest, latches_a_wheel_that_stands_while_the_robot_creeps) {
  make_ready();
  measured = {0.0, 0.0};
  BaseFeedback feedback;
  int periods_until_fault = 0;
  for (; feedback.state != BaseState::fault && periods_until_fault < 100; ++periods_until_fault) {
    driver.command({0.12, -0.57});
    feedback = period();
  }
  EXPECT_EQ(feedback.fault, BaseFault::not_following);
  // 0.12 s until even the slowest base turns at 0.35 rad/s, and 1 s of patience.
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

TEST_F(BaseDriverTest, latches_a_base_that_ignores_its_commands) {
  make_ready();
  BaseFeedback feedback;
  int periods_until_fault = 0;
  for (; feedback.state != BaseState::fault && periods_until_fault < 100; ++periods_until_fault) {
    driver.command({0.6, 0.0});
    feedback = period();
  }
  EXPECT_EQ(feedback.fault, BaseFault::not_following);
  // 0.3 s until even the slowest base moves at 0.3 m/s, and 0.2 s of patience.
  EXPECT_NEAR(periods_until_fault, 25, 2);
}

TEST_F(BaseDriverTest, blames_no_base_for_a_pause_of_its_own) {
  make_ready();
  driver.command({0.6, 0.0});
  period();
  now += milliseconds(400);  // in which even the slowest base would have sped up
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

TEST_F(BaseDriverTest, counts_states_that_it_does_not_know) {
  hear({agilex::system_state_id, 8, {0, 9}});
  hear({agilex::system_state_id, 8, {9, 1}});
  driver.poll(now);
  EXPECT_EQ(driver.counts().odd_frames, 2U);
}

TEST_F(BaseDriverTest, counts_odd_frames_and_drives_on) {
  make_ready();
  hear({agilex::odometer_id, 7, {}});
  hear({agilex::motion_state_id, 0, {}});
  hear({agilex::system_state_id, 6, {}});
  hear({0x251, 8, {}});  // a motor's report is not odd, only not ours
  EXPECT_EQ(period().state, BaseState::ready);
  EXPECT_EQ(driver.counts().odd_frames, 3U);
}

TEST_F(BaseDriverTest, survives_any_frames) {
  Random random(8);
  constexpr std::array ids{0x111U, 0x211U, 0x221U, 0x311U, 0x421U, 0x441U};
  for (int trial = 0; trial < 20'000; ++trial) {
    CanFrame frame{
        random.below(4) == 0 ? static_cast<std::uint32_t>(random.bits()) : ids[random.below(ids.size())],
        static_cast<std::uint8_t>(random.below(256)),
        {}};
    for (auto& byte : frame.data) byte = random.below(2) == 0 ? 0 : static_cast<std::uint8_t>(random.bits());
    now += milliseconds(random.below(50));
    hear(frame);
    if (random.below(3) == 0) base_speaks();
    const BaseFeedback feedback = driver.poll(now);
    driver.command({random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)});
    if (feedback.state == BaseState::fault) (void)driver.resume(now);
    for (const WheelTravel& travel : feedback.travel) EXPECT_TRUE(std::isfinite(travel.left_m));
  }
}

TEST(BaseWords, tell_states_and_faults_apart) {
  std::set<std::string_view> words;
  for (const BaseState state :
       {BaseState::waiting_for_base, BaseState::asking_for_can_mode, BaseState::ready, BaseState::fault}) {
    words.insert(to_string(state));
  }
  for (const BaseFault fault : {BaseFault::feedback_lost, BaseFault::left_can_mode, BaseFault::emergency_stop,
                                BaseFault::vehicle_exception, BaseFault::fault_bits, BaseFault::not_following,
                                BaseFault::second_master, BaseFault::send_failed}) {
    words.insert(to_string(fault));
  }
  EXPECT_EQ(words.size(), 12U);
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
  EXPECT_NE(period().state, BaseState::ready) << "the guard has not let go yet";
  bus.state = BusState::up;
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, is_slow_while_the_controller_is_error_passive) {
  make_ready();
  bus.state = BusState::error_passive;
  EXPECT_EQ(period().state, BaseState::ready);
  driver.command({1.0, 0.0});
  EXPECT_NEAR(agilex::decode_motion_command(bus.sent.back())->forward_mps, 0.3, 1e-9);
}

TEST_F(BaseDriverTest, releases_a_base_that_somebody_else_has_taken) {
  make_ready();
  system.mode = ControlMode::remote;
  expect_latched(BaseFault::left_can_mode, period());
  EXPECT_EQ(bus.releases, 1) << "so that no guard stops it in our name";
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
