#include "drivers/can/candump.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using std::chrono::microseconds;

std::vector<LoggedCanFrame> read(const std::string& text) {
  std::istringstream in(text);
  return read_candump(in, "can.log");
}

TEST(Candump, writes_the_lines_that_canplayer_reads) {
  const Stamp stamp(std::chrono::seconds(1'700'000'000) + microseconds(123'456));
  EXPECT_EQ(candump_line({stamp, {0x123, 8, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}}}),
            "(1700000000.123456) can0 123#1122334455667788");
  EXPECT_EQ(candump_line({Stamp(microseconds(20'000)), {0x1, 0, {}}}, "vcan1"),
            "(0000000000.020000) vcan1 001#");
}

TEST(Candump, reads_both_precisions_and_the_direction) {
  const auto frames = read(
      "(1700000000.123456) can0 123#1122334455667788\n"
      "(0000000001.000000789) vcan0 7fF#aB R\n"
      "(2.500000) can0 000# T\n");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].received.stamp, Stamp(std::chrono::seconds(1'700'000'000) + microseconds(123'456)));
  EXPECT_EQ(frames[0].received.frame, (CanFrame{0x123, 8, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}}));
  EXPECT_EQ(frames[1].received.stamp, Stamp(std::chrono::nanoseconds(1'000'000'789)));
  EXPECT_EQ(frames[1].received.frame, (CanFrame{0x7FF, 1, {0xAB}}));
  EXPECT_EQ(frames[1].interface, "vcan0");
  EXPECT_EQ(frames[2].received.frame.length, 0);
  EXPECT_TRUE(read("").empty());
}

TEST(Candump, gives_back_what_was_written) {
  Random random(3);
  std::ostringstream out;
  CandumpWriter writer(out);
  std::vector<StampedCanFrame> sent;
  for (int i = 0; i < 1000; ++i) {
    StampedCanFrame frame{
        Stamp(microseconds(random.below(1'000'000'000'000))),
        {static_cast<std::uint32_t>(random.below(0x800)), static_cast<std::uint8_t>(random.below(9)), {}}};
    for (std::size_t k = 0; k < frame.frame.length; ++k)
      frame.frame.data[k] = static_cast<std::uint8_t>(random.bits());
    sent.push_back(frame);
    writer.write(frame);
  }
  const auto heard = read(out.str());
  ASSERT_EQ(heard.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(heard[i].received.stamp, sent[i].stamp);
    EXPECT_EQ(heard[i].received.frame, sent[i].frame);
  }
}

class CandumpRefusal : public testing::TestWithParam<const char*> {};

TEST_P(CandumpRefusal, names_file_and_line) {
  try {
    (void)read(std::string("(1.000000) can0 111#00\n") + GetParam() + "\n");
    FAIL() << "was accepted: " << GetParam();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("can.log:2: found '"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Lines, CandumpRefusal,
    testing::Values("", " ", "(1.000000) can0 111#0", "(1.000000) can0 111#001122334455667788",
                    "(1.000000) can0 800#00", "(1.000000) can0 00000111#00", "(1.000000) can0 20000040#0000",
                    "(1.000000) can0 111#R", "(1.000000) can0 111##100", "(1.000000) can0 111#00_E",
                    "(1.00000) can0 111#00", "(1.0000000) can0 111#00", "(-1.000000) can0 111#00",
                    "(1.-00001) can0 111#00", "(99999999999.000000) can0 111#00", "(x.000000) can0 111#00",
                    "1.000000 can0 111#00", "(1.000000)can0 111#00", "(1.000000)  111#00",
                    "(1.000000) can0 111", "(1.000000) can0 11G#00", "(1.000000) can0 111#0G",
                    "(1.000000) can0 111#00 ", "(1.000000) can0 111#00 X", "(1.000000) can0 111#00 RR",
                    "(1.000000) can0 111#00\r", "(1.000000", "(1.000000) can0",
                    "DROPCOUNT: dropped 3 CAN frames on 'can0' socket", "\x01\xff"));

TEST(Candump, refuses_a_file_that_is_not_there) {
  EXPECT_THROW((void)load_candump("no/such/can.log"), InputError);
  EXPECT_THROW((void)load_candump("."), InputError);
}

TEST(Candump, survives_any_text) {
  Random random(4);
  const std::string letters = "(0123456789.) can#ABCDEFabcdefRT_\n";
  int taken = 0;
  int refused = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string text = "(1.000000) can0 111#0011\n";
    for (int change = 0; change < 3; ++change)
      text[random.below(text.size())] = letters[random.below(letters.size())];
    try {
      for (const auto& frame : read(text)) {
        EXPECT_LE(frame.received.frame.length, 8);
        ++taken;
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(taken, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace lodestar
