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

TEST_F(Clients, of_odrive_find_both_axes_and_drive_them) {
  expect_to_serve("odrive");
}

}  // namespace
}  // namespace lodestar
