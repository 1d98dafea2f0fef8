#include <csignal>

#include "tests/app/net/socket_client.hpp"
#include "tests/can/lab.hpp"

// The web console of a robot on a real kernel's CAN: operators command it from a browser.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

class Console : public CanLab {
 protected:
  void serve() {
    start_base();
    start_run("--serve --port 0 -o run");
    ASSERT_TRUE(wait_for_words("http://127.0.0.1:", 20s)) << run->output();
    const std::string output = run->output();
    const std::string before_port = "http://127.0.0.1:";
    port =
        static_cast<unsigned short>(std::stoi(output.substr(output.find(before_port) + before_port.size())));
    ASSERT_TRUE(wait_for_words("base: ready", 20s));
  }

  [[nodiscard]] std::unique_ptr<SocketClient> at_the_wheel() const {
    auto client = std::make_unique<SocketClient>(port);
    client->upgrade("lodestar.v1");
    client->send(R"({"type": "take"})");
    return client;
  }

  /// Holds control (a "hold" message every 200 ms) until the robot prints the words.
  bool drive_until(SocketClient& client, const std::string& words, Duration longest) const {
    for (const Stamp end = monotonic_now() + longest; monotonic_now() < end;) {
      client.send(R"({"type": "hold"})");
      if (wait_for_words(words, 200ms)) return true;
    }
    return false;
  }

  bool drive_until_fast(SocketClient& client) const {
    for (const Stamp end = monotonic_now() + 20s; monotonic_now() < end;) {
      client.send(R"({"type": "hold"})");
      if (witness->wait_for(drives_faster_than(0.3), monotonic_now(), 200ms)) return true;
    }
    return false;
  }

  unsigned short port = 0;
};

TEST_F(Console, sends_the_robot_which_arrives) {
  serve();
  const auto client = at_the_wheel();
  EXPECT_FALSE(witness->wait_for(is_moving_command, Stamp{}, 500ms))
      << "motion commanded before a goal was sent";
  client->send(R"({"type": "go", "goals": [[2.4, 5.5]]})");
  EXPECT_TRUE(drive_until(*client, "goal 1: arrived", 40s)) << run->output();
  EXPECT_TRUE(wait_for_words("run folder: ", 20s));
  run->signal(SIGTERM);
  EXPECT_EQ(run->wait(10s), 0);
  const Truth truth = end_base();
  EXPECT_NEAR(truth.x_m, 2.4, 0.03);
  EXPECT_NEAR(truth.y_m, 5.5, 0.03);
  EXPECT_EQ(truth.contacts, 0);
}

/// A closed browser, or a lost network: nobody is in control.
TEST_F(Console, a_driver_who_is_gone_stops_the_robot) {
  serve();
  auto client = at_the_wheel();
  client->send(R"({"type": "go", "goals": [[4.2, 5.5]]})");
  ASSERT_TRUE(drive_until_fast(*client)) << run->output();
  const Stamp gone = monotonic_now();
  client.reset();
  expect_no_motion_after(2500ms, gone);  // braking from 0.6 m/s within the limits takes 1.2 s
}

TEST_F(Console, anybody_stops_the_robot) {
  serve();
  const auto driver = at_the_wheel();
  driver->send(R"({"type": "go", "goals": [[4.2, 5.5]]})");
  ASSERT_TRUE(drive_until_fast(*driver)) << run->output();
  SocketClient other(port);
  other.upgrade("lodestar.v1");
  driver->send(R"({"type": "hold"})");
  const Stamp said = monotonic_now();
  other.send(R"({"type": "stop"})");
  EXPECT_TRUE(drive_until(*driver, "stopped by the operator", 5s)) << run->output();
  expect_no_motion_after(2000ms, said);
}

}  // namespace
}  // namespace lodestar
