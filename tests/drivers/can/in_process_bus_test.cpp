#include "drivers/can/in_process_bus.hpp"

#include <gtest/gtest.h>

#include "drivers/can/can_wire.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

Stamp at_ms(int ms) {
  return Stamp(milliseconds(ms));
}

CanFrame frame(std::uint32_t id) {
  return {id, 1, {1}};
}

std::vector<std::uint32_t> ids_heard(CanBus& bus) {
  std::vector<std::uint32_t> ids;
  while (const auto received = bus.poll()) ids.push_back(received->frame.id);
  return ids;
}

// Computed outside this program, by long division of the CRC polynomial.
TEST(CanWire, counts_stuff_bits_exactly) {
  EXPECT_EQ(bits_on_wire({0x111, 8, {0x00, 0x96}}), 124);
  EXPECT_EQ(bits_on_wire({0x211, 8, {0, 1, 1, 4, 0, 0, 0, 0x7F}}), 123);
  EXPECT_EQ(bits_on_wire({0x000, 8, {}}), 127);
  // Runs of four bits, each extended to five by the stuff bit before.
  EXPECT_EQ(bits_on_wire({0x078, 8, {0x3C, 0x3C, 0x3C, 0x3C, 0x3C, 0x3C, 0x3C, 0x3C}}), 131);
  EXPECT_EQ(bits_on_wire({0x555, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}}), 112);
  EXPECT_EQ(bits_on_wire({0x421, 1, {1}}), 57);
  EXPECT_EQ(bits_on_wire({0x7FF, 0, {}}), 50);
}

TEST(CanWire, stays_within_the_bounds_of_the_standard) {
  Random random(6);
  for (int trial = 0; trial < 10'000; ++trial) {
    const auto length = static_cast<int>(random.below(9));
    CanFrame any{static_cast<std::uint32_t>(random.below(0x800)), static_cast<std::uint8_t>(length), {}};
    for (auto& byte : any.data) byte = random.below(2) == 0 ? 0x00 : static_cast<std::uint8_t>(random.bits());
    const int unstuffed = 47 + 8 * length;
    EXPECT_GE(bits_on_wire(any), unstuffed);
    EXPECT_LE(bits_on_wire(any), unstuffed + (33 + 8 * length) / 4);
  }
}

TEST(InProcessBus, brings_a_frame_to_all_others_after_its_time_on_the_wire) {
  InProcessBus bus({.bit_rate_bps = 500'000.0, .latency = milliseconds(1)});
  CanBus& sender = bus.attach();
  CanBus& near = bus.attach();
  CanBus& far = bus.attach();
  const CanFrame sent{0x111, 8, {0x00, 0x96}};  // 124 bits: 248 us
  ASSERT_TRUE(sender.send(sent));

  bus.advance(Stamp(microseconds(1247)));
  EXPECT_FALSE(near.poll());
  bus.advance(Stamp(microseconds(1248)));
  for (CanBus* end : {&near, &far}) {
    const auto received = end->poll();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->stamp, Stamp(microseconds(1248)));
    EXPECT_EQ(received->frame, sent);
    EXPECT_FALSE(end->poll());
  }
  EXPECT_FALSE(sender.poll()) << "a sender does not receive its own frames";
}

TEST(InProcessBus, lets_the_lowest_waiting_identifier_go_first) {
  InProcessBus bus;
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  CanBus& listener = bus.attach();
  ASSERT_TRUE(a.send(frame(0x311)));
  ASSERT_TRUE(a.send(frame(0x100)));  // queued behind 0x311: each end sends in order
  ASSERT_TRUE(b.send(frame(0x211)));
  ASSERT_TRUE(b.send(frame(0x7FF)));
  bus.advance(at_ms(10));
  EXPECT_EQ(ids_heard(listener), (std::vector<std::uint32_t>{0x211, 0x311, 0x100, 0x7FF}));
}

TEST(InProcessBus, never_breaks_into_a_frame_that_is_on_the_wire) {
  InProcessBus bus;
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  CanBus& listener = bus.attach();
  ASSERT_TRUE(a.send(frame(0x700)));
  bus.advance(Stamp(microseconds(50)));  // on the wire until about 116 us
  ASSERT_TRUE(a.send(frame(0x600)));
  ASSERT_TRUE(b.send(frame(0x001)));
  bus.advance(at_ms(10));
  EXPECT_EQ(ids_heard(listener), (std::vector<std::uint32_t>{0x700, 0x001, 0x600}));
}

TEST(InProcessBus, tells_its_listener_each_frame_once_in_the_order_of_the_wire) {
  InProcessBus bus({.latency = milliseconds(5)});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  std::vector<StampedCanFrame> log;
  bus.on_frame([&](const StampedCanFrame& seen) { log.push_back(seen); });
  ASSERT_TRUE(a.send(frame(0x222)));
  ASSERT_TRUE(b.send(frame(0x111)));
  bus.advance(at_ms(1));
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].frame.id, 0x111U);
  EXPECT_EQ(log[0].stamp, Stamp(microseconds(2) * bits_on_wire(frame(0x111))))
      << "stamped before the latency";
  EXPECT_EQ(log[1].stamp - log[0].stamp, Duration(microseconds(2) * bits_on_wire(frame(0x222))));
}

TEST(InProcessBus, refuses_what_does_not_fit) {
  InProcessBus bus({.transmit_queue = 2, .receive_queue = 3});
  CanBus& sender = bus.attach();
  CanBus& listener = bus.attach();
  EXPECT_FALSE(sender.send({0x800, 0, {}})) << "not an 11-bit identifier";
  EXPECT_FALSE(sender.send({0x100, 9, {}}));
  EXPECT_TRUE(sender.send(frame(1)));
  EXPECT_TRUE(sender.send(frame(2)));
  EXPECT_FALSE(sender.send(frame(3))) << "transmit queue full";
  bus.advance(at_ms(1));
  EXPECT_TRUE(sender.send(frame(3)));
  EXPECT_TRUE(sender.send(frame(4)));
  bus.advance(at_ms(2));
  EXPECT_EQ(bus.lost_frames(), 1U) << "receive queue full";
  EXPECT_EQ(ids_heard(listener), (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(InProcessBus, time_never_runs_backwards) {
  InProcessBus bus;
  CanBus& sender = bus.attach();
  CanBus& listener = bus.attach();
  bus.advance(at_ms(10));
  bus.advance(at_ms(5));
  ASSERT_TRUE(sender.send(frame(1)));
  bus.advance(at_ms(20));
  EXPECT_GT(listener.poll()->stamp, at_ms(10));
}

TEST(InProcessBus, gives_the_same_stamps_however_time_is_cut) {
  const auto log_of = [](int step_ms) {
    InProcessBus bus;
    CanBus& a = bus.attach();
    CanBus& b = bus.attach();
    std::vector<std::pair<Stamp, std::uint32_t>> log;
    bus.on_frame([&](const StampedCanFrame& seen) { log.emplace_back(seen.stamp, seen.frame.id); });
    Random random(7);
    for (int ms = 0; ms < 1000; ms += 10) {
      for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE((i % 2 == 0 ? a : b).send(frame(static_cast<std::uint32_t>(random.below(0x800)))));
      }
      for (int passed = 0; passed < 10; passed += step_ms) bus.advance(at_ms(ms + passed + step_ms));
    }
    return log;
  };
  EXPECT_EQ(log_of(1), log_of(10));
  EXPECT_EQ(log_of(5).size(), 500U);
}

}  // namespace
}  // namespace lodestar
