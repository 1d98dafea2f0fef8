#include "drivers/simulation/simulated_periphery.hpp"

#include <gtest/gtest.h>
#include <map>
#include <string>

#include "drivers/base/agilex_v2_table.hpp"
#include "drivers/can/in_process_bus.hpp"

namespace lodestar {
namespace {

using std::chrono::milliseconds;
namespace tables = agilex::tables;

/// Frames of lights, motors and battery that a client receives.
class SimulatedPeripheryTest : public testing::Test {
 protected:
  void pass_on_frames() {
    now += milliseconds(20);
    bus.advance(now);
    while (const auto heard = client.poll()) {
      newest[heard->frame.id] = heard->frame;
      ++counts[heard->frame.id];
      if (heard->frame.id != tables::version_text.id) continue;
      text.append(heard->frame.data.begin(), heard->frame.data.end());
    }
  }

  void handle(const CanFrame& frame) { periphery.handle(frame); }

  void answer_all() {
    for (int i = 0; i < 20; ++i) {
      periphery.send_answer();
      pass_on_frames();
    }
  }

  InProcessBus bus;
  CanBus& client = bus.attach();
  SimulatedPeriphery periphery{bus.attach(), 26.0};
  Stamp now;
  std::map<std::uint32_t, CanFrame> newest;
  std::map<std::uint32_t, int> counts;
  std::string text;
};

TEST_F(SimulatedPeripheryTest, says_everything_at_its_period) {
  for (int i = 0; i < 100; ++i) {
    periphery.send_feedback({}, 0.4);
    pass_on_frames();
  }
  for (const MessageSpec& message :
       {tables::motor1_fast, tables::motor2_fast, tables::light_state, tables::remote_state,
        tables::motor1_slow, tables::motor2_slow, tables::battery_state, tables::battery_extended}) {
    EXPECT_EQ(counts[message.id], 100 * milliseconds(20) / message.period) << message.name;
  }
}

TEST_F(SimulatedPeripheryTest, tells_how_fast_each_motor_turns) {
  periphery.send_feedback({0.5, 1.0}, 0.4);  // 0.3 and 0.7 m/s, 0.5 m per turn of the wheel
  pass_on_frames();
  EXPECT_DOUBLE_EQ((*decode(tables::motor1_fast, newest[0x251]))[0], 36.0);
  EXPECT_DOUBLE_EQ((*decode(tables::motor2_fast, newest[0x252]))[0], 84.0);
}

TEST_F(SimulatedPeripheryTest, shows_the_lights_as_they_were_commanded) {
  periphery.send_feedback({}, 0.4);
  pass_on_frames();
  EXPECT_EQ((*decode(tables::light_state, newest[0x231]))[1], 0.0) << "off at power-up";

  handle(encode(tables::light_command, {1.0, 3.0, 40.0, 1.0, 0.0}));
  periphery.send_feedback({}, 0.4);
  pass_on_frames();
  const auto lights = *decode(tables::light_state, newest[0x231]);
  EXPECT_EQ(lights[0], 1.0);
  EXPECT_EQ(lights[1], 3.0);
  EXPECT_EQ(lights[2], 40.0);
}

TEST_F(SimulatedPeripheryTest, answers_the_question_for_its_version_with_eighty_letters) {
  answer_all();
  EXPECT_EQ(text, "") << "no request yet";
  handle({tables::version_text.id, 8, {1}});
  handle({tables::version_text.id, 1, {2}});
  answer_all();
  EXPECT_EQ(text, "") << "that was not a request";

  handle({tables::version_text.id, 1, {1}});
  answer_all();
  EXPECT_EQ(counts[tables::version_text.id], 10);
  EXPECT_EQ(text.size(), 80U);
  EXPECT_EQ(text.substr(0, 8), "LODESTAR");
  for (const char letter : text) EXPECT_TRUE(letter >= ' ' && letter <= '~');
}

TEST_F(SimulatedPeripheryTest, answers_the_manuals_question_with_numbers) {
  handle({0x411, 1, {1}});
  answer_all();
  ASSERT_EQ(counts[0x41A], 1);
  const SignalValues versions = *decode(tables::version_answer, newest[0x41A]);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(versions.at(i), 0x0100);
}

}  // namespace
}  // namespace lodestar
