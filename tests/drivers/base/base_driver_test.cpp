#include "drivers/base/base_driver.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "maps/random.hpp"

#include "tests/drivers/base/base_driver_fixture.hpp"

namespace lodestar {
namespace {

using namespace testing;
using agilex::ControlMode;
using agilex::VehicleState;
using std::chrono::milliseconds;

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
  ++system.counter;
  EXPECT_EQ(driver.poll(now).state, BaseState::waiting_for_base);
  EXPECT_EQ(period().state, BaseState::ready);
}

TEST_F(BaseDriverTest, counts_missing_system_states) {
  make_ready();
  system.counter = static_cast<std::uint8_t>(system.counter + 3);
  EXPECT_EQ(period().state, BaseState::ready);
  EXPECT_EQ(driver.counts().counter_jumps, 1U);
  EXPECT_EQ(periods(300).state, BaseState::ready);
  EXPECT_EQ(driver.counts().counter_jumps, 1U) << "a wraparound is not a jump";
}

TEST_F(BaseDriverTest, keeps_the_curve_of_a_command_that_is_too_fast) {
  make_ready();
  driver.command({2.0, 1.0});
  EXPECT_EQ(bus.sent.back(), agilex::encode_motion_command({1.0, 0.5}));
  driver.command({0.5, -4.0});
  EXPECT_EQ(bus.sent.back(), agilex::encode_motion_command({0.25, -2.0}));
  EXPECT_EQ(driver.saturated_commands(), 2U);
  driver.command({1.0, -2.0});
  EXPECT_EQ(driver.saturated_commands(), 2U) << "a command at the limit is not saturated";
}

TEST_F(BaseDriverTest, keeps_each_wheel_within_its_limit) {
  BaseDriver slow(bus, {.max_wheel_mps = 0.5, .track_width_m = 0.4});
  system.mode = ControlMode::can;
  base_speaks();
  ASSERT_EQ(slow.poll(now).state, BaseState::ready);
  slow.command({0.6, 2.0});  // the outer wheel: 1 m/s
  EXPECT_EQ(bus.sent.back(), agilex::encode_motion_command({0.3, 1.0}));
}

TEST_F(BaseDriverTest, knows_the_control_modes_of_each_model_and_of_another_firmware) {
  const auto mode_read = [](BaseProtocol& protocol, std::uint8_t value) {
    return protocol.decode({Stamp(), {agilex::system_state_id, 8, {0, value}}}).system->mode;
  };
  const auto tracer = make_agilex_protocol();
  EXPECT_EQ(mode_read(*tracer, 2), ControlMode::uart);
  EXPECT_EQ(mode_read(*tracer, 3), ControlMode::remote);
  EXPECT_EQ(mode_read(*tracer, 4), ControlMode::unknown);
  EXPECT_EQ(mode_read(*make_agilex_protocol(BaseModel::hunter), 2), ControlMode::remote);
  const auto other = make_agilex_protocol(BaseModel::tracer, 5.0,
                                          {ControlMode::remote, ControlMode::standby, ControlMode::can});
  EXPECT_EQ(mode_read(*other, 0), ControlMode::remote);
  EXPECT_EQ(mode_read(*other, 2), ControlMode::can);
  EXPECT_EQ(other->enable(), (std::vector<CanFrame>{{0x421, 1, {2}}}));
}

TEST_F(BaseDriverTest, sends_zero_for_a_velocity_that_is_not_finite) {
  make_ready();
  driver.command({std::nan(""), 0.5});
  driver.command({0.5, std::numeric_limits<double>::infinity()});
  ASSERT_EQ(bus.sent.size(), 2U);
  for (const CanFrame& frame : bus.sent) EXPECT_EQ(frame, agilex::encode_motion_command({}));
  EXPECT_EQ(driver.counts().non_finite_commands, 2U);
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
  hear({0x251, 8, {}});  // a motor's report is unused, but valid
  EXPECT_EQ(period().state, BaseState::ready);
  EXPECT_EQ(driver.counts().odd_frames, 3U);
}

TEST_F(BaseDriverTest, survives_any_frames) {
  Random random(8);
  constexpr std::array ids{0x111U, 0x211U, 0x221U, 0x311U, 0x421U, 0x441U};
  system.mode = ControlMode::can;
  std::set<BaseState> states;
  std::size_t readings = 0;
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
    states.insert(feedback.state);
    readings += feedback.travel.size();
  }
  EXPECT_EQ(states.size(), 4U) << "every state was reached";
  EXPECT_GT(readings, 1000U);
}

TEST(BaseWords, tell_states_and_faults_apart) {
  std::set<std::string_view> words;
  for (const BaseState state :
       {BaseState::waiting_for_base, BaseState::asking_for_can_mode, BaseState::ready, BaseState::fault}) {
    words.insert(to_string(state));
  }
  for (const BaseFault fault :
       {BaseFault::feedback_lost, BaseFault::feedback_incomplete, BaseFault::counter_stuck,
        BaseFault::left_can_mode, BaseFault::emergency_stop, BaseFault::vehicle_exception,
        BaseFault::fault_bits, BaseFault::not_following, BaseFault::second_master, BaseFault::send_failed}) {
    words.insert(to_string(fault));
  }
  EXPECT_EQ(words.size(), 14U);
}

TEST_F(BaseDriverTest, is_slow_while_the_controller_is_error_passive) {
  make_ready();
  bus.state = BusState::error_passive;
  EXPECT_EQ(period().state, BaseState::ready);
  driver.command({1.0, 0.0});
  EXPECT_NEAR(agilex::decode_motion_command(bus.sent.back())->forward_mps, 0.3, 1e-9);
}

}  // namespace
}  // namespace lodestar
