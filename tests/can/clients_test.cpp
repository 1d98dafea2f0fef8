#include "tests/can/lab.hpp"

// Third-party clients drive the simulated base.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class Clients : public CanLab {
 protected:
  /// Expects that a third-party client receives every frame that it waits for, and drives the base.
  void expect_to_serve(const std::string& protocol) {
    ASSERT_TRUE(shell(LODESTAR_BINARY " base --protocol " + protocol + " --dbc >" + protocol + ".dbc"));
    start_base("--protocol " + protocol);
    ASSERT_TRUE(witness->wait_for([](const CanFrame&) { return true; }, Stamp{}, 20s))
        << "the base never sent a frame";
    Process client({"/usr/bin/python3", LODESTAR_SOURCE_DIR "/tests/can/vendor_client.py", protocol, base_end,
                    protocol + ".dbc"});
    EXPECT_EQ(client.wait(60s), 0) << client.output();
    EXPECT_GT(end_base().driven_m, 0.4) << "distance by ground truth";
  }
};

TEST_F(Clients, of_agilex_find_the_base_and_drive_it) {
  expect_to_serve("agilex");
}

TEST_F(Clients, find_no_base_on_an_interface_that_is_missing_or_switched_off) {
  base_end = "can7";
  start_base();
  EXPECT_EQ(base->wait(20s), 2);
  std::string said = base->end();
  EXPECT_NE(said.find("--can: found that can7 does not exist"), std::string::npos) << said;
  EXPECT_EQ(said.find("a simulated base runs"), std::string::npos) << said;
  ASSERT_TRUE(shell("ip link set vcan0 down"));
  base_end = "vcan0";
  start_base();
  EXPECT_EQ(base->wait(20s), 2);
  said = base->end();
  EXPECT_NE(said.find("--can: found that vcan0 is down"), std::string::npos) << said;
}

TEST_F(Clients, of_odrive_find_both_axes_and_drive_them) {
  expect_to_serve("odrive");
}

}  // namespace
}  // namespace lodestar
