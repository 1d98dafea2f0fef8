#include "drivers/simulation/simulated_base.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <sstream>

#include "tests/drivers/base/base_on_a_bus.hpp"
#include "tests/drivers/perfect_base.hpp"
#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

using namespace testing;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(SimulatedBase, is_handed_over_by_the_handshake) {
  World world;
  world.wait(milliseconds(20));
  EXPECT_NE(world.feedback.state, BaseState::ready);
  world.wait(milliseconds(200));
  EXPECT_EQ(world.feedback.state, BaseState::ready);
  EXPECT_EQ(world.driver.counts().odd_frames, 0U);
  EXPECT_NE(world.log_text.str().find(" can0 421#01\n"), std::string::npos);
}

/// A base without a navigator; the test sends every frame.
struct BareBase {
  /// Sends the velocity, if any, every 20 ms; returns the distance travelled along x.
  double run(Duration time, const std::optional<BodyVelocity>& velocity) {
    const double before_m = motion.true_map_from_base().position_m.x();
    for (const Stamp end = now + time; now < end;) {
      now += milliseconds(1);
      if (velocity && now.time_since_epoch() % milliseconds(20) == Duration::zero()) {
        EXPECT_TRUE(stranger.send(agilex::encode_motion_command(*velocity)));
      }
      motion.step(milliseconds(1));
      bus.advance(now);
      base.step(now);
    }
    return motion.true_map_from_base().position_m.x() - before_m;
  }
  void ask_for(agilex::ControlMode mode) { EXPECT_TRUE(stranger.send(agilex::encode_control_mode(mode))); }

  InProcessBus bus;
  CanBus& stranger = bus.attach();
  SimulatedMotion motion{perfect_base(), {}, 1};
  SimulatedBase base{bus.attach(), motion, perfect_base()};
  Stamp now;
};

TEST(SimulatedBase, takes_no_command_while_it_stands_by) {
  BareBase bare;
  EXPECT_EQ(bare.run(seconds(1), BodyVelocity{0.5, 0.0}), 0.0);
  bare.ask_for(agilex::ControlMode::remote);
  EXPECT_EQ(bare.run(seconds(1), BodyVelocity{0.5, 0.0}), 0.0)
      << "asking for remote mode gives a client no control";
  bare.ask_for(agilex::ControlMode::can);
  EXPECT_GT(bare.run(seconds(1), BodyVelocity{0.5, 0.0}), 0.3);
}

/// As a real base's firmware does, whatever its client asks for.
TEST(SimulatedBase, limits_the_speeds_that_it_is_told) {
  BareBase bare;
  bare.ask_for(agilex::ControlMode::can);
  bare.run(seconds(3), BodyVelocity{0.0, 30.0});
  const double before_rad = bare.motion.true_map_from_base().yaw_rad;
  bare.run(milliseconds(500), BodyVelocity{0.0, 30.0});
  const double turned_rad = wrap_angle(bare.motion.true_map_from_base().yaw_rad - before_rad);
  EXPECT_NEAR(turned_rad, 0.5 * SimulatedBaseOptions{}.max_turn_radps, 0.02);

  BareBase straight;
  straight.ask_for(agilex::ControlMode::can);
  straight.run(seconds(3), BodyVelocity{30.0, 0.0});
  EXPECT_NEAR(straight.run(seconds(1), BodyVelocity{30.0, 0.0}), SimulatedBaseOptions{}.max_forward_mps,
              0.02);
}

TEST(SimulatedBase, forgets_its_command_when_it_is_stopped) {
  BareBase bare;
  bare.ask_for(agilex::ControlMode::can);
  bare.run(seconds(2), BodyVelocity{0.5, 0.0});
  bare.base.press_emergency_stop(true);
  bare.run(milliseconds(20), std::nullopt);
  bare.base.press_emergency_stop(false);
  EXPECT_LT(bare.run(milliseconds(400), std::nullopt), 0.15) << "the stop voids a command before its timeout";
}

TEST(SimulatedBase, keeps_the_curve_of_a_command_beyond_its_motors) {
  BareBase bare;
  bare.ask_for(agilex::ControlMode::can);
  bare.run(seconds(3), BodyVelocity{6.0, 3.0});
  const Pose2 before = bare.motion.true_map_from_base();
  bare.run(milliseconds(100), BodyVelocity{6.0, 3.0});
  const Pose2 moved = inverse(before) * bare.motion.true_map_from_base();
  // Wheels at 5.4 and 6.6 m/s become 1.309 and 1.6 m/s: the centre of the circle stays 2 m to the left.
  EXPECT_NEAR(moved.position_m.norm(), 0.1454, 0.001);
  EXPECT_NEAR(moved.position_m.norm() / moved.yaw_rad, 2.0, 0.01);
}

TEST(SimulatedBase, drives_as_commanded_over_the_bus) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(4));
  EXPECT_NEAR(world.feedback.measured->forward_mps, 0.5, 0.03);
  world.drive({}, seconds(2));
  // Lag delays start and stop equally, so the distance is as commanded.
  EXPECT_NEAR(world.truth().position_m.x(), 2.0, 0.03);
  EXPECT_NEAR(world.truth().position_m.y(), 0.0, 1e-9);
  EXPECT_NEAR(world.travel.left_m, world.truth().position_m.x(), 0.002);
  EXPECT_EQ(world.feedback.state, BaseState::ready);
}

TEST(SimulatedBase, drives_on_when_a_third_of_all_frames_is_lost) {
  World world(perfect_base(), 1, std::nullopt, 0.3);
  world.wait(milliseconds(500));
  for (int i = 0; i < 30; ++i) {
    world.drive({0.6, 0.3}, seconds(1));
    world.drive({-0.6, -0.3}, seconds(1));
  }
  EXPECT_EQ(world.feedback.state, BaseState::ready);
  EXPECT_GT(world.driver.counts().counter_jumps, 500U);
  EXPECT_NEAR(world.travel.left_m, world.motion.left_encoder_m(), 0.1) << "lost frames lose no travel";
}

TEST(SimulatedBase, drives_on_when_every_frame_comes_50_ms_late) {
  SimulatedBaseOptions options = perfect_base();
  options.can_latency = milliseconds(50);
  World world(options);
  world.wait(milliseconds(500));
  for (int i = 0; i < 5; ++i) {
    world.drive({0.6, 0.0}, seconds(2));
    world.drive({-0.6, 0.5}, seconds(2));
  }
  EXPECT_EQ(world.feedback.state, BaseState::ready);
}

TEST(SimulatedBase, turns_on_the_spot_as_commanded) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.0, 1.0}, seconds(2));
  world.drive({}, seconds(1));
  EXPECT_NEAR(world.truth().yaw_rad, 2.0, 0.03);
  EXPECT_NEAR(world.truth().position_m.norm(), 0.0, 1e-9);
  EXPECT_NEAR((world.travel.right_m - world.travel.left_m) / 0.40, world.truth().yaw_rad, 0.01);
}

TEST(SimulatedBase, comes_to_rest_when_the_commands_stop) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.6, 0.0}, seconds(3));
  world.wait(milliseconds(480));
  const double before_timeout_m = world.truth().position_m.x();
  EXPECT_NEAR(world.feedback.measured->forward_mps, 0.6, 0.03) << "the base keeps the last command 500 ms";
  // Braking from 0.6 m/s at 2 m/s^2 takes 300 ms, then the lag of the speed loop.
  world.wait(milliseconds(20 + 300 + 6 * 80));
  const double at_rest_m = world.truth().position_m.x();
  world.wait(seconds(1));
  EXPECT_NEAR(world.truth().position_m.x(), at_rest_m, 1e-3);
  EXPECT_NEAR(at_rest_m - before_timeout_m, 0.02 * 0.6 + 0.6 * 0.6 / (2 * 2.0), 0.04);
  EXPECT_EQ(world.feedback.state, BaseState::ready) << "the base reports no fault";
}

TEST(SimulatedBase, unequal_wheels_bend_what_the_odometer_believes_straight) {
  SimulatedBaseOptions options = perfect_base();
  options.left_wheel_scale = 1.006;
  options.right_wheel_scale = 0.994;
  World world(options);
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(4));
  world.drive({}, seconds(1));
  EXPECT_NEAR(world.travel.left_m, world.travel.right_m, 1e-9) << "the odometer shows a straight line";
  const double rolled_m = world.travel.left_m;
  EXPECT_NEAR(world.truth().yaw_rad, -0.012 * rolled_m / options.true_track_width_m, 1e-3);
  EXPECT_LT(world.truth().position_m.y(), -0.04);
}

TEST(SimulatedBase, odometer_may_wrap_around_on_the_way) {
  SimulatedBaseOptions options = perfect_base();
  options.odometer_start_mm = std::numeric_limits<std::int32_t>::max() - 500;
  World world(options);
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(4));
  EXPECT_NEAR(world.travel.left_m, world.truth().position_m.x(), 0.02);
  EXPECT_EQ(world.driver.counts().odd_frames, 0U);
}

TEST(SimulatedBase, sends_each_state_every_20_ms) {
  World world;
  world.wait(seconds(1));
  std::istringstream log(world.log_text.str());
  std::vector<Stamp> odometers;
  for (const LoggedCanFrame& logged : read_candump(log, "can.log")) {
    if (logged.received.frame.id == agilex::odometer_id) odometers.push_back(logged.received.stamp);
  }
  ASSERT_GE(odometers.size(), 49U);
  for (std::size_t i = 1; i < odometers.size(); ++i) {
    EXPECT_NEAR(lodestar::seconds(odometers[i] - odometers[i - 1]), 0.020, 0.0005);
  }
}

TEST(SimulatedBase, emergency_stop_stops_it_and_releasing_it_moves_nothing) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(2));
  world.base.press_emergency_stop(true);
  world.drive({0.5, 0.0}, milliseconds(40));
  EXPECT_EQ(world.feedback.fault, BaseFault::emergency_stop);
  world.drive({0.5, 0.0}, seconds(1));
  const double at_rest_m = world.truth().position_m.x();
  EXPECT_FALSE(world.driver.resume(world.now));
  world.base.press_emergency_stop(false);
  world.drive({0.5, 0.0}, seconds(1));
  EXPECT_NEAR(world.truth().position_m.x(), at_rest_m, 1e-4);
  EXPECT_EQ(world.feedback.state, BaseState::fault);

  EXPECT_TRUE(world.driver.resume(world.now));
  world.drive({0.5, 0.0}, seconds(1));
  EXPECT_GT(world.truth().position_m.x(), at_rest_m + 0.2);
}

TEST(SimulatedBase, remote_control_takes_it_without_a_fight) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(2));
  world.base.take_over_by_remote(true);
  world.drive({0.5, 0.0}, milliseconds(40));
  EXPECT_EQ(world.feedback.fault, BaseFault::left_can_mode);
  const std::size_t log_length = world.log_text.str().size();
  world.drive({0.5, 0.0}, seconds(1));
  const std::string since = world.log_text.str().substr(log_length);
  EXPECT_EQ(since.find(" 111#"), std::string::npos);
  EXPECT_EQ(since.find(" 421#"), std::string::npos);
  ASSERT_TRUE(world.bus.attach().send(agilex::encode_control_mode(agilex::ControlMode::can)));
  world.wait(milliseconds(100));
  EXPECT_EQ(world.feedback.system->mode, agilex::ControlMode::remote) << "remote control has priority";

  world.base.take_over_by_remote(false);
  world.drive({0.5, 0.0}, milliseconds(100));
  EXPECT_EQ(world.feedback.state, BaseState::fault);
  EXPECT_TRUE(world.driver.resume(world.now));
  world.drive({0.5, 0.0}, milliseconds(200));
  EXPECT_EQ(world.feedback.state, BaseState::ready);
}

TEST(SimulatedBase, fault_bits_stop_it_until_they_are_cleared) {
  World world(perfect_base());
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(1));
  world.base.set_fault_bits(0x0100);
  world.drive({0.5, 0.0}, seconds(1));
  EXPECT_EQ(world.feedback.state, BaseState::fault);
  EXPECT_FALSE(world.driver.resume(world.now));
  ASSERT_TRUE(world.bus.attach().send(agilex::encode_clear_fault()));
  world.wait(milliseconds(40));
  EXPECT_TRUE(world.driver.resume(world.now));
}

TEST(SimulatedBase, stops_against_an_obstacle_and_may_turn_away) {
  OccupancyMap map;
  map.columns = 20;
  map.rows = 10;
  map.resolution_m = 0.1;
  map.map_from_grid.position_m = {-0.5, -0.5};
  map.cells.assign(200, OccupancyMap::free);
  for (int row = 0; row < 10; ++row) map.cells[map.index({15, row})] = OccupancyMap::occupied;  // x = 1.0 m
  World world(perfect_base(), 1, SimulatedMotion::Surroundings{map, 0.2});
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(4));
  EXPECT_TRUE(world.motion.is_blocked());
  EXPECT_NEAR(world.truth().position_m.x(), 0.8, 0.001);
  EXPECT_LE(world.truth().position_m.x(), 0.8 + 1e-9);
  EXPECT_GT(world.travel.left_m, 1.5) << "the wheels keep spinning";
  world.drive({0.0, 1.0}, milliseconds(3200));
  world.drive({0.5, 0.0}, seconds(1));
  EXPECT_FALSE(world.motion.is_blocked());
  EXPECT_LT(world.truth().position_m.x(), 0.5);
}

TEST(SimulatedBase, with_a_footprint_stops_with_its_nose_against_an_obstacle) {
  OccupancyMap map = empty_floor(20, 10, 0.1);
  map.map_from_grid.position_m = {-0.5, -0.5};
  for (int row = 0; row < 10; ++row) map.cells[map.index({15, row})] = OccupancyMap::occupied;  // x = 1.0 m
  const Footprint plank({{-0.4, -0.1}, {0.4, -0.1}, {0.4, 0.1}, {-0.4, 0.1}});
  World world(perfect_base(), 1, SimulatedMotion::Surroundings{map, 0.2, plank});
  world.wait(milliseconds(200));
  world.drive({0.5, 0.0}, seconds(4));
  EXPECT_TRUE(world.motion.is_blocked());
  EXPECT_NEAR(world.truth().position_m.x(), 0.6, 0.001);
  world.drive({0.0, 1.0}, seconds(1));
  EXPECT_LT(std::abs(world.truth().yaw_rad), 0.05) << "its corners would sweep into the wall";
}

TEST(SimulatedBase, the_same_seed_gives_the_same_bytes_and_another_seed_another_track) {
  const auto drive = [](std::uint64_t seed) {
    World world({}, seed);
    world.wait(milliseconds(200));
    world.drive({0.5, 0.3}, seconds(3));
    return std::pair(world.log_text.str(), world.truth().position_m);
  };
  const auto [log, position] = drive(7);
  const auto [log_again, position_again] = drive(7);
  EXPECT_EQ(log, log_again);
  EXPECT_EQ(position, position_again);
  EXPECT_NE(drive(8).second, position);
  EXPECT_GT(log.size(), 10'000U);
}

}  // namespace
}  // namespace lodestar
