#include "drivers/base/protocol_table.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "drivers/base/agilex_v2_table.hpp"
#include "drivers/base/odrive_table.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using Bytes = std::array<std::uint8_t, 8>;

class Tables : public testing::TestWithParam<const ProtocolTable*> {};

TEST_P(Tables, have_one_identifier_for_each_message_and_room_for_each_signal) {
  std::set<std::uint32_t> seen;
  for (const MessageSpec& message : GetParam()->messages) {
    EXPECT_TRUE(seen.insert(message.id).second) << message.name;
    EXPECT_LE(message.signals.size(), most_signals) << message.name;
    std::uint64_t used = 0;
    for (const Signal& signal : message.signals) {
      const int first = 8 * signal.byte + signal.bit;
      ASSERT_LE(first + signal.bits, 8 * message.length) << message.name << "." << signal.name;
      for (int i = first; i < first + signal.bits; ++i) {
        EXPECT_EQ((used >> static_cast<unsigned>(i)) & 1U, 0U) << signal.name << " overlaps another";
        used |= std::uint64_t{1} << static_cast<unsigned>(i);
      }
    }
  }
}

TEST_P(Tables, give_back_every_value_that_they_take) {
  Random random(4);
  for (const MessageSpec& message : GetParam()->messages) {
    for (int trial = 0; trial < 200; ++trial) {
      SignalValues values{};
      for (std::size_t i = 0; i < message.signals.size(); ++i) {
        const SignalRange range = range_of(message.signals[i]);
        const double wish = message.signals[i].kind == SignalKind::float32
                                ? 1e3 * random.normal()
                                : range.low + random.uniform() * (range.high - range.low);
        values.at(i) = wish;
      }
      const CanFrame frame = encode(message, values);
      const auto back = decode(message, frame);
      ASSERT_TRUE(back) << message.name;
      EXPECT_EQ(encode(message, *back), frame) << message.name;
      for (std::size_t i = 0; i < message.signals.size(); ++i) {
        const double step = message.signals[i].kind == SignalKind::float32 ? 1e-3 : message.signals[i].scale;
        EXPECT_NEAR(back->at(i), values.at(i), 0.5001 * step)
            << message.name << "." << message.signals[i].name;
      }
    }
  }
}

TEST_P(Tables, read_any_frame_and_bring_nothing_that_is_not_finite) {
  Random random(5);
  int could_read = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    CanFrame frame;
    const auto& messages = GetParam()->messages;
    const MessageSpec& message = messages[random.bits() % messages.size()];
    frame.id = message.id;
    frame.length = static_cast<std::uint8_t>(random.bits() % 9);
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random.bits());
    const auto values = decode(message, frame);
    EXPECT_FALSE(values && frame.length < message.least_length);
    if (!values) continue;
    ++could_read;
    for (const double value : *values) ASSERT_TRUE(std::isfinite(value));
  }
  EXPECT_GT(could_read, 5000);
}

INSTANTIATE_TEST_SUITE_P(Protocols, Tables, testing::Values(&agilex::table, &odrive::table),
                         [](const auto& table) { return std::string(table.param->name); });

TEST(ProtocolTable, codes_floats_little_endian_for_each_node) {
  // 1.5f is 0x3FC00000.
  const CanFrame frame = encode(odrive::tables::set_input_velocity, {1.5, 0.0}, 3 * odrive::node_step);
  EXPECT_EQ(frame, (CanFrame{0x06D, 8, Bytes{0x00, 0x00, 0xC0, 0x3F}}));
  EXPECT_FALSE(decode(odrive::tables::set_input_velocity, frame));
  EXPECT_DOUBLE_EQ((*decode(odrive::tables::set_input_velocity, frame, 3 * odrive::node_step))[0], 1.5);
}

TEST(ProtocolTable, refuses_a_float_that_is_no_number) {
  EXPECT_FALSE(decode(odrive::tables::encoder_estimates, {0x009, 8, Bytes{0, 0, 0xC0, 0x7F}}));
  EXPECT_FALSE(decode(odrive::tables::encoder_estimates, {0x009, 8, Bytes{0, 0, 0x80, 0x7F}}));
  EXPECT_EQ(encode(odrive::tables::set_input_velocity, {std::nan(""), 0.0}).data, Bytes{});
}

TEST(ProtocolTable, codes_bits_within_a_byte) {
  using agilex::tables::remote_state;
  const CanFrame frame = encode(remote_state, {2, 1, 3, 2, -100, 100, -1, 0});
  EXPECT_EQ(frame, (CanFrame{0x241, 8, Bytes{0b10'11'01'10, 0x9C, 0x64, 0xFF, 0x00}}));
  EXPECT_DOUBLE_EQ((*decode(remote_state, frame))[2], 3.0);
}

}  // namespace
}  // namespace lodestar
