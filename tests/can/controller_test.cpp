#include "drivers/can/can_interface.hpp"

#include "tests/can/lab.hpp"
#include "tests/can/slcan_adapter.hpp"

// A CAN controller with the kernel's own driver and error states.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class Controller : public CanLab {
 protected:
  void lay_cable() override {
    CanLab::lay_cable();
    adapter = std::make_unique<SlcanAdapter>(base_end);
    navigator_end = adapter->interface();
    ASSERT_TRUE(shell("ip link set " + navigator_end + " txqueuelen 10 up"));
  }
  void take_cable_away() override {
    adapter.reset();
    CanLab::take_cable_away();
  }

  std::unique_ptr<SlcanAdapter> adapter;
};

TEST_F(Controller, that_goes_bus_off_is_noticed_and_driven_with_again_after_a_restart_and_a_resume) {
  start_base();
  start_run("--goal 2.4,5.5");
  wait_until_driving();
  const Stamp off = monotonic_now();
  adapter->bus_off();
  expect_said_within(20ms, "base: stopped by a fault (the CAN controller is bus-off)", off);
  EXPECT_EQ(look_at_can_interface(navigator_end).controller, "bus-off");
  run->say("resume");
  EXPECT_TRUE(wait_for_words("cannot resume", 1s));
  measure("controller bus-off", off);

  adapter->back_on_bus();
  const Stamp back = monotonic_now();
  ASSERT_TRUE(shell("ip link set " + navigator_end + " down && ip link set " + navigator_end + " up"));
  EXPECT_FALSE(witness->wait_for(is_moving_command, back, 1s))
      << "motion commanded without a resume, or an old command";
  EXPECT_EQ(resume_and_wait_for_the_end(40s), 0);
}

}  // namespace
}  // namespace lodestar
