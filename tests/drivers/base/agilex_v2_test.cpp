#include "drivers/base/agilex_v2.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>

#include "maps/random.hpp"

namespace lodestar::agilex {
namespace {

using Bytes = std::array<std::uint8_t, 8>;

TEST(AgilexV2, sends_the_examples_of_the_manual) {
  EXPECT_EQ(encode_motion_command({0.15, 0.0}), (CanFrame{0x111, 8, Bytes{0x00, 0x96}}));
  EXPECT_EQ(encode_motion_command({0.0, 0.05}), (CanFrame{0x111, 8, Bytes{0, 0, 0x00, 0x32}}));
  EXPECT_EQ(encode_control_mode(ControlMode::can), (CanFrame{0x421, 1, Bytes{1}}));
  EXPECT_EQ(encode_clear_fault(), (CanFrame{0x441, 1, Bytes{0}}));
}

TEST(AgilexV2, is_big_endian_and_twos_complement) {
  EXPECT_EQ(encode_motion_command({-0.001, -1.0}), (CanFrame{0x111, 8, Bytes{0xFF, 0xFF, 0xFC, 0x18}}));
  EXPECT_EQ(encode_odometer({-2, 0x01020304}),
            (CanFrame{0x311, 8, Bytes{0xFF, 0xFF, 0xFF, 0xFE, 1, 2, 3, 4}}));
  EXPECT_EQ(encode_system_state({VehicleState::emergency_stop, ControlMode::remote, 26.1, 0x0204, 200}),
            (CanFrame{0x211, 8, Bytes{1, 3, 0x01, 0x05, 0x02, 0x04, 0, 200}}));
  EXPECT_EQ(encode_motion_state({0.3, 0.0}), (CanFrame{0x221, 8, Bytes{0x01, 0x2C}}));
}

TEST(AgilexV2, rounds_to_the_nearest_step) {
  EXPECT_EQ(encode_motion_command({0.0009, -0.0009}), encode_motion_command({0.001, -0.001}));
  EXPECT_EQ(encode_motion_command({0.0004, -0.0004}), encode_motion_command({0.0, 0.0}));
}

TEST(AgilexV2, saturates_instead_of_wrapping_around) {
  const double huge = std::numeric_limits<double>::max();
  const double infinity = std::numeric_limits<double>::infinity();
  const CanFrame most{0x111, 8, Bytes{0x7F, 0xFF, 0x80, 0x00}};
  EXPECT_EQ(encode_motion_command({1e3, -1e3}), most);
  EXPECT_EQ(encode_motion_command({huge, -huge}), most);
  EXPECT_EQ(encode_motion_command({infinity, -infinity}), most);
  EXPECT_EQ(encode_motion_command({std::nan(""), std::nan("")}), encode_motion_command({}));
  EXPECT_DOUBLE_EQ(decode_system_state(encode_system_state({.battery_v = 1e9}))->battery_v, 6553.5);
  EXPECT_DOUBLE_EQ(decode_system_state(encode_system_state({.battery_v = -5.0}))->battery_v, 0.0);
}

TEST(AgilexV2, ignores_other_identifiers_and_short_frames) {
  const CanFrame command = encode_motion_command({0.15, 0.0});
  EXPECT_FALSE(decode_motion_state(command));
  EXPECT_FALSE(decode_odometer(command));
  EXPECT_FALSE(decode_system_state(command));
  for (std::uint8_t length = 0; length < 8; ++length) {
    EXPECT_FALSE(decode_motion_command({0x111, length, command.data}));
    EXPECT_FALSE(decode_system_state({0x211, length, {}}));
    EXPECT_FALSE(decode_motion_state({0x221, length, {}}));
    EXPECT_FALSE(decode_odometer({0x311, length, {}}));
  }
}

TEST(AgilexV2, takes_a_control_frame_of_any_length_but_none) {
  EXPECT_FALSE(decode_control_mode({0x421, 0, {}}));
  EXPECT_EQ(decode_control_mode({0x421, 1, {1}}), ControlMode::can);
  EXPECT_EQ(decode_control_mode({0x421, 8, {1}}), ControlMode::can);
  EXPECT_FALSE(is_clear_fault({0x441, 0, {}}));
  EXPECT_TRUE(is_clear_fault({0x441, 8, {}}));
  EXPECT_FALSE(is_clear_fault({0x441, 1, {3}})) << "clears one motor only";
}

TEST(AgilexV2, reads_a_state_that_the_protocol_does_not_name_as_unknown) {
  const auto state = decode_system_state({0x211, 8, Bytes{7, 9}});
  ASSERT_TRUE(state);
  EXPECT_EQ(state->vehicle, VehicleState::unknown);
  EXPECT_EQ(state->mode, ControlMode::unknown);
  EXPECT_EQ(decode_control_mode({0x421, 1, {4}}), ControlMode::unknown);
}

TEST(AgilexV2, gives_back_what_was_sent) {
  Random random(1);
  for (int trial = 0; trial < 10'000; ++trial) {
    const BodyVelocity velocity{random.uniform(-32.0, 32.0), random.uniform(-32.0, 32.0)};
    const auto heard = decode_motion_command(encode_motion_command(velocity));
    ASSERT_TRUE(heard);
    EXPECT_NEAR(heard->forward_mps, velocity.forward_mps, 0.0005 + 1e-12);
    EXPECT_NEAR(heard->turn_radps, velocity.turn_radps, 0.0005 + 1e-12);

    const Odometer odometer{static_cast<std::int32_t>(static_cast<std::uint32_t>(random.bits())),
                            static_cast<std::int32_t>(static_cast<std::uint32_t>(random.bits()))};
    const auto read = decode_odometer(encode_odometer(odometer));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->left_mm, odometer.left_mm);
    EXPECT_EQ(read->right_mm, odometer.right_mm);
  }
}

TEST(AgilexV2, encodes_again_whatever_it_could_read) {
  Random random(2);
  constexpr std::array ids{0x111U, 0x211U, 0x221U, 0x311U, 0x421U, 0x441U};
  std::map<std::uint32_t, int> could_read;
  for (int trial = 0; trial < 20'000; ++trial) {
    CanFrame frame{ids[random.below(ids.size())], static_cast<std::uint8_t>(random.below(256)), {}};
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random.bits());
    if (const auto velocity = decode_motion_command(frame)) {
      ++could_read[frame.id];
      EXPECT_EQ(decode_motion_command(encode_motion_command(*velocity))->turn_radps, velocity->turn_radps);
    }
    if (const auto velocity = decode_motion_state(frame)) {
      ++could_read[frame.id];
      EXPECT_EQ(decode_motion_state(encode_motion_state(*velocity))->forward_mps, velocity->forward_mps);
    }
    if (const auto state = decode_system_state(frame)) {
      ++could_read[frame.id];
      const auto again = decode_system_state(encode_system_state(*state));
      EXPECT_EQ(again->vehicle, state->vehicle);
      EXPECT_EQ(again->mode, state->mode);
      EXPECT_EQ(again->battery_v, state->battery_v);
      EXPECT_EQ(again->fault_bits, state->fault_bits);
      EXPECT_EQ(again->counter, state->counter);
    }
    if (const auto odometer = decode_odometer(frame)) {
      ++could_read[frame.id];
      EXPECT_EQ(encode_odometer(*odometer).data, frame.data);
    }
    if (const auto mode = decode_control_mode(frame)) {
      ++could_read[frame.id];
      EXPECT_EQ(decode_control_mode(encode_control_mode(*mode)), *mode);
    }
    if (is_clear_fault(frame)) ++could_read[frame.id];
  }
  for (const std::uint32_t id : ids) EXPECT_GT(could_read[id], 10) << id;
}

}  // namespace
}  // namespace lodestar::agilex
