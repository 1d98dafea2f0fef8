#include <gtest/gtest.h>
#include <map>

#include "drivers/base/base_driver.hpp"
#include "drivers/base/odrive_table.hpp"
#include "drivers/can/in_process_bus.hpp"
#include "drivers/simulation/simulated_motion.hpp"
#include "drivers/simulation/simulated_odrive.hpp"

#include "tests/drivers/perfect_base.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Two axes at one end of a bus, the driver at the other.
struct World {
  explicit World(const SimulatedOdriveOptions& options = {})
      : motion(perfect_base(), {}, 1), base(bus.attach(), motion, options) {}

  void drive(const BodyVelocity& velocity, Duration time, bool commands = true) {
    for (const Stamp end = now + time; now < end;) {
      now += milliseconds(1);
      motion.step(milliseconds(1));
      bus.advance(now);
      base.step(now);
      if (now.time_since_epoch() % milliseconds(20) != Duration::zero()) continue;
      feedback = driver.poll(now);
      if (!feedback.travel.empty()) travel = feedback.travel.back();
      if (commands) driver.command(velocity);
    }
  }

  InProcessBus bus;
  CanBus& navigator_end = bus.attach();
  SimulatedMotion motion;
  SimulatedOdrive base;
  BaseDriver driver{navigator_end, make_odrive_protocol({})};
  Stamp now;
  BaseFeedback feedback;
  WheelTravel travel;
};

TEST(Odrive, takes_both_axes_into_closed_loop_and_drives) {
  World world;
  world.drive({}, milliseconds(400));
  ASSERT_EQ(world.feedback.state, BaseState::ready);
  world.drive({0.5, 0.0}, seconds(2));
  EXPECT_NEAR(world.feedback.measured->forward_mps, 0.5, 0.02);
  EXPECT_NEAR(world.feedback.measured->turn_radps, 0.0, 0.05);
  world.drive({0.0, 0.0}, seconds(1));
  const double rolled_m = (world.travel.left_m + world.travel.right_m) / 2.0;
  EXPECT_NEAR(rolled_m, world.motion.true_map_from_base().position_m.x(), 0.005);
  EXPECT_NEAR(rolled_m, 0.9, 0.1);
  EXPECT_EQ(world.driver.counts().odd_frames, 0U);
}

TEST(Odrive, turns_counter_clockwise_when_told_so) {
  World world;
  world.drive({}, milliseconds(400));
  world.drive({0.0, 0.8}, seconds(1));
  EXPECT_GT(world.motion.true_map_from_base().yaw_rad, 0.5);
  EXPECT_NEAR(world.feedback.measured->turn_radps, 0.8, 0.05);
}

TEST(Odrive, stays_stopped_after_an_emergency_stop_until_its_errors_are_cleared_and_somebody_resumes) {
  World world;
  world.drive({}, milliseconds(400));
  world.base.press_emergency_stop(true);
  world.drive({0.3, 0.0}, milliseconds(300));
  EXPECT_EQ(world.feedback.fault, BaseFault::emergency_stop);
  EXPECT_FALSE(world.driver.resume(world.now));
  world.drive({0.3, 0.0}, milliseconds(300));
  world.base.press_emergency_stop(false);
  world.drive({0.3, 0.0}, milliseconds(300));
  EXPECT_EQ(world.feedback.state, BaseState::fault) << "a release does not resume";
  EXPECT_FALSE(world.driver.resume(world.now)) << "the first resume makes the axes clear their errors";
  world.drive({}, milliseconds(300));
  EXPECT_TRUE(world.driver.resume(world.now));
  world.drive({0.3, 0.0}, seconds(1));
  EXPECT_GT(world.feedback.measured->forward_mps, 0.25);
}

TEST(Odrive, half_a_base_is_no_base) {
  InProcessBus bus;
  BaseDriver driver(bus.attach(), make_odrive_protocol({}));
  CanBus& left_axis = bus.attach();
  for (int i = 0; i < 100; ++i) {
    const Stamp now(milliseconds(20) * i);
    EXPECT_TRUE(left_axis.send(encode(odrive::tables::heartbeat, {0.0, 8.0})));
    EXPECT_TRUE(left_axis.send(encode(odrive::tables::encoder_estimates, {})));
    bus.advance(now);
    EXPECT_NE(driver.poll(now).state, BaseState::ready);
  }
}

TEST(Odrive, with_a_watchdog_goes_idle_when_nobody_commands) {
  World world({.watchdog = milliseconds(200)});
  world.drive({}, milliseconds(400));
  world.drive({0.5, 0.0}, seconds(1));
  world.drive({}, seconds(1), false);
  EXPECT_EQ(world.feedback.fault, BaseFault::fault_bits);
  EXPECT_EQ(make_odrive_protocol({})->fault_names(world.feedback.system->fault_bits),
            std::vector<std::string>{"watchdog expired"});
}

/// After a run nobody commands, and the watchdog expires.
TEST(Odrive, whose_watchdog_expired_drives_for_the_next_run_when_told_to_resume) {
  World world({.watchdog = milliseconds(200)});
  world.drive({}, milliseconds(400));
  world.drive({}, seconds(1), false);

  BaseDriver next(world.bus.attach(), make_odrive_protocol({}));
  const auto poll_for = [&](Duration time) {
    BaseFeedback feedback;
    for (const Stamp end = world.now + time; world.now < end;) {
      world.now += milliseconds(1);
      world.bus.advance(world.now);
      world.base.step(world.now);
      if (world.now.time_since_epoch() % milliseconds(20) != Duration::zero()) continue;
      feedback = next.poll(world.now);
      next.command({});
    }
    return feedback;
  };
  const BaseFeedback waiting = poll_for(seconds(2));
  EXPECT_EQ(waiting.state, BaseState::waiting_for_base);
  EXPECT_EQ(waiting.details, "watchdog expired");
  EXPECT_TRUE(next.resume(world.now));
  EXPECT_EQ(poll_for(seconds(1)).state, BaseState::ready);
}

TEST(Odrive, tells_who_is_on_the_bus) {
  World world;
  CanBus& client = world.bus.attach();
  world.drive({}, milliseconds(400));
  while (client.poll()) continue;
  ASSERT_TRUE(client.send({odrive::address_of_all, 0, {}}));
  world.drive({}, milliseconds(20));
  std::map<double, double> serial_of_node;
  while (const auto heard = client.poll()) {
    for (const std::uint32_t node : {0U, 1U}) {
      const auto said = decode(odrive::tables::address, heard->frame, node * odrive::node_step);
      if (said) serial_of_node[(*said)[0]] = (*said)[1];
    }
  }
  const auto serial = static_cast<double>(SimulatedOdriveOptions{}.serial);
  EXPECT_EQ(serial_of_node, (std::map<double, double>{{0.0, serial}, {1.0, serial}}));
}

TEST(Odrive, coasts_without_torque_when_it_is_idle) {
  World world;
  CanBus& client = world.bus.attach();
  world.drive({}, milliseconds(400));
  world.drive({0.5, 0.0}, seconds(1));
  const auto torque_nm = [&] {
    double newest_nm = -1.0;
    while (const auto heard = client.poll()) {
      if (const auto said = decode(odrive::tables::torques, heard->frame)) newest_nm = (*said)[1];
    }
    return newest_nm;
  };
  EXPECT_GT(torque_nm(), 0.1);
  ASSERT_TRUE(client.send(encode(odrive::tables::set_axis_state, {odrive::idle})));
  world.drive({}, milliseconds(110), false);
  ASSERT_GT(world.feedback.measured->forward_mps, 0.05) << "it still rolls";
  EXPECT_EQ(torque_nm(), 0.0);
}

/// Messages that a client receives on request.
TEST(Odrive, answers_requests_and_only_those) {
  World world;
  CanBus& client = world.bus.attach();
  const auto heard_of = [&](std::uint32_t id) {
    int count = 0;
    while (const auto heard = client.poll()) count += heard->frame.id == id ? 1 : 0;
    return count;
  };
  world.drive({}, milliseconds(400));
  EXPECT_EQ(heard_of(odrive::tables::version.id), 0) << "the version is not cyclic";

  ASSERT_TRUE(client.send({odrive::tables::version.id + odrive::node_step, 0, {}}));
  world.drive({}, milliseconds(20));
  EXPECT_EQ(heard_of(odrive::tables::version.id + odrive::node_step), 1);

  ASSERT_TRUE(client.send({odrive::tables::set_limits.id, 0, {}}));
  world.drive({}, milliseconds(20));
  EXPECT_EQ(heard_of(odrive::tables::set_limits.id), 0) << "set_limits is no request";
}

TEST(Odrive, stands_in_another_control_mode_than_velocity) {
  World world;
  world.drive({}, milliseconds(400));
  ASSERT_TRUE(world.navigator_end.send(encode(odrive::tables::set_controller_mode, {3.0, 1.0})));
  world.drive({0.5, 0.0}, milliseconds(300));
  EXPECT_LT(world.motion.left_encoder_m(), 0.01) << "the left axis controls positions now";
  EXPECT_GT(world.motion.right_encoder_m(), 0.03);
}

TEST(Odrive, remembers_why_it_disarmed_until_errors_are_cleared) {
  World world;
  CanBus& client = world.bus.attach();
  world.drive({}, milliseconds(400));
  const auto disarm_reason = [&] {
    double reason = -1.0;
    while (const auto heard = client.poll()) {
      if (const auto said = decode(odrive::tables::error, heard->frame)) reason = (*said)[1];
    }
    return reason;
  };
  EXPECT_EQ(disarm_reason(), 0.0);
  world.base.press_emergency_stop(true);
  world.drive({}, milliseconds(200));
  EXPECT_EQ(disarm_reason(), odrive::estop_requested);
  world.base.press_emergency_stop(false);
  ASSERT_TRUE(client.send(encode(odrive::tables::clear_errors, {})));
  world.drive({}, milliseconds(200));
  EXPECT_EQ(disarm_reason(), 0.0);
}

}  // namespace
}  // namespace lodestar
