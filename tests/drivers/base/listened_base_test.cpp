#include "drivers/base/listened_base.hpp"

#include "drivers/base/agilex_v2.hpp"

#include "tests/drivers/base/base_driver_fixture.hpp"

namespace lodestar::testing {
namespace {

using namespace std::chrono_literals;

TEST(ListenedBaseTest, hears_a_base_that_another_drives_and_sends_nothing) {
  ScriptedBus bus;
  ListenedBase base(bus, make_agilex_protocol());
  Stamp now(10s);
  EXPECT_EQ(base.poll(now).state, BaseState::waiting_for_base);
  SystemState system{.mode = ControlMode::standby, .battery_v = 25.0};
  std::vector<WheelTravel> rolled;
  for (int i = 0; i < 50; ++i) {
    now += 20ms;
    ++system.counter;
    bus.arriving.push_back({now, agilex::encode_system_state(system)});
    bus.arriving.push_back({now, agilex::encode_motion_state({.forward_mps = 0.5})});
    bus.arriving.push_back({now, agilex::encode_odometer({.left_mm = 10 * i, .right_mm = 10 * i})});
    bus.arriving.push_back({now, make_agilex_protocol()->command({.forward_mps = 0.5}).front()});
    const BaseFeedback feedback = base.poll(now);
    EXPECT_EQ(feedback.state, BaseState::ready);
    EXPECT_FALSE(feedback.fault);
    rolled.insert(rolled.end(), feedback.travel.begin(), feedback.travel.end());
  }
  ASSERT_EQ(rolled.size(), 50U);
  EXPECT_NEAR(rolled.back().left_m - rolled.front().left_m, 0.49, 1e-9);

  now += 1s;
  const BaseFeedback silent = base.poll(now);
  EXPECT_EQ(silent.state, BaseState::waiting_for_base);
  EXPECT_EQ(silent.fault, BaseFault::feedback_lost);
  EXPECT_TRUE(bus.sent.empty());
}

}  // namespace
}  // namespace lodestar::testing
