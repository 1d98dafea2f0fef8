#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "tests/can/lab.hpp"
#include "tests/drivers/system/manager_socket.hpp"

// The robot as a service: what its control loop tells the service manager.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

constexpr Duration watchdog = 2s;

class Service : public CanLab {
 protected:
  Service() {
    ::setenv("NOTIFY_SOCKET", manager.path().c_str(), 1);
    ::setenv("WATCHDOG_USEC", "2000000", 1);
  }
  ~Service() override {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }

  /// Number of times that this was said within that time.
  [[nodiscard]] std::ptrdiff_t heard_in(Duration duration, const std::string& words) const {
    sleep_until(monotonic_now() + duration);
    return std::ranges::count(manager.hear(), words);
  }

  [[nodiscard]] bool hears(const std::string& words, Duration longest) const {
    for (const Stamp end = monotonic_now() + longest; monotonic_now() < end;)
      if (heard_in(50ms, words) > 0) return true;
    return false;
  }

  ManagerSocket manager;
};

TEST_F(Service, is_ready_once_its_loop_runs_and_silent_when_it_hangs) {
  start_base();
  start_run("--serve --port 0 -o run");
  ASSERT_TRUE(hears("READY=1\nWATCHDOG=1", 20s)) << run->output();
  EXPECT_GE(heard_in(watchdog, "WATCHDOG=1"), 3);  // the manager wants one
  ASSERT_TRUE(wait_for_words("base: ready", 20s));

  run->signal(SIGSTOP);
  (void)manager.hear();
  EXPECT_EQ(heard_in(watchdog, "WATCHDOG=1"), 0);
  run->signal(SIGCONT);
  EXPECT_TRUE(hears("WATCHDOG=1", 2s));

  run->signal(SIGTERM);
  EXPECT_TRUE(hears("STOPPING=1", 5s));
  EXPECT_EQ(run->wait(20s), 0);
}

}  // namespace
}  // namespace lodestar
