#include "drivers/can/candump_bus.hpp"

#include <gtest/gtest.h>
#include <sstream>

#include "drivers/base/agilex_v2.hpp"
#include "drivers/base/base_driver.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;

std::vector<LoggedCanFrame> log_of(const std::string& text) {
  std::istringstream in(text);
  return read_candump(in, "log");
}

TEST(CandumpBus, brings_frames_when_their_time_has_come_and_not_the_listeners_own) {
  CandumpBus bus(log_of("(1700000000.000000) can0 221#0000000000000000\n"
                        "(1700000000.005000) can0 111#0064000000000000\n"
                        "(1700000000.020000) can0 221#0064000000000000\n"),
                 {agilex::motion_command_id}, Stamp(milliseconds(100)));
  bus.advance(Stamp(milliseconds(110)));
  const auto first = bus.poll();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, Stamp(milliseconds(100)));
  EXPECT_FALSE(bus.poll());
  bus.advance(Stamp(milliseconds(120)));
  EXPECT_EQ(bus.poll()->frame, agilex::encode_motion_state({0.1, 0.0}));
  EXPECT_TRUE(bus.at_end());
  EXPECT_EQ(bus.health().counts.received, 2U);
}

TEST(CandumpBus, lets_the_driver_hear_a_recorded_base) {
  std::ostringstream text;
  CandumpWriter writer(text);
  for (int i = 0; i < 10; ++i) {
    const Stamp stamp(milliseconds(1000 + 20 * i));
    writer.write({stamp, agilex::encode_system_state(
                             {.mode = ControlMode::can, .counter = static_cast<std::uint8_t>(i)})});
    writer.write({stamp, agilex::encode_motion_state({})});
    writer.write({stamp, agilex::encode_odometer({i, i})});
  }
  CandumpBus bus(log_of(text.str()), {}, Stamp(milliseconds(0)));
  BaseDriver driver(bus);
  double travel_m = 0.0;
  for (Stamp now; !bus.at_end(); now += milliseconds(20)) {
    bus.advance(now);
    const BaseFeedback feedback = driver.poll(now);
    EXPECT_EQ(feedback.state, BaseState::ready);
    travel_m = feedback.travel.back().left_m;
  }
  EXPECT_DOUBLE_EQ(travel_m, 0.009);
}

}  // namespace
}  // namespace lodestar
