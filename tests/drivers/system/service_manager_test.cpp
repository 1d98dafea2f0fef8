#include "drivers/system/service_manager.hpp"

#include <cstdlib>
#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/drivers/system/manager_socket.hpp"

namespace lodestar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Duration watchdog = std::chrono::seconds(2);

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

class Service : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return socket_.path(); }
  [[nodiscard]] std::vector<std::string> hear() const { return socket_.hear(); }

 private:
  ManagerSocket socket_;
};

TEST_F(Service, is_told_that_the_loop_runs_and_then_that_it_goes_on) {
  ServiceManager manager({.socket = path(), .watchdog = watchdog});
  EXPECT_THAT(hear(), IsEmpty());  // opening cameras and buses is not yet being ready
  manager.step(at(10.00));
  EXPECT_THAT(hear(), ElementsAre("READY=1\nWATCHDOG=1"));
  for (const double time_s : {10.02, 10.04, 10.48}) manager.step(at(time_s));
  EXPECT_THAT(hear(), IsEmpty());
  for (const double time_s : {10.50, 10.52, 11.00, 11.02}) manager.step(at(time_s));
  EXPECT_THAT(hear(), ElementsAre("WATCHDOG=1", "WATCHDOG=1"));
}

TEST_F(Service, without_watchdog_is_told_once) {
  ServiceManager manager({.socket = path(), .watchdog = std::nullopt});
  for (double time_s = 0.0; time_s < 10.0; time_s += 0.02) manager.step(at(time_s));
  EXPECT_THAT(hear(), ElementsAre("READY=1\nWATCHDOG=1"));
}

TEST_F(Service, that_does_not_read_holds_up_nobody_and_is_told_later) {
  ServiceManager manager({.socket = path(), .watchdog = watchdog});
  for (int i = 0; i < 5000; ++i) manager.tell_status("drives");  // more than any queue holds
  manager.step(at(1.0));
  EXPECT_THAT(hear(), testing::Not(testing::Contains("READY=1\nWATCHDOG=1")));
  manager.step(at(1.02));
  EXPECT_THAT(hear(), ElementsAre("READY=1\nWATCHDOG=1"));
}

TEST_F(Service, has_a_status_of_one_line) {
  ServiceManager manager({.socket = path(), .watchdog = std::nullopt});
  manager.tell_status("base: waits\nMAINPID=1");
  manager.stop();
  EXPECT_THAT(hear(), ElementsAre("STATUS=base: waits MAINPID=1", "STOPPING=1"));
}

TEST(ServiceManager, that_is_not_there_is_told_nothing) {
  for (const char* socket : {"", "relative", "/no/such/socket"}) {
    ServiceManager manager({.socket = socket, .watchdog = watchdog});
    manager.step(at(1.0));
    manager.tell_status("drives");
    manager.stop();
  }
}

TEST(ServiceEnvironment, has_the_watchdog_of_this_process_alone) {
  ::setenv("NOTIFY_SOCKET", "@manager", 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_EQ(service_environment().socket, "@manager");
  EXPECT_EQ(service_environment().watchdog, watchdog);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid() + 1).c_str(), 1);
  EXPECT_EQ(service_environment().watchdog, std::nullopt);
  ::unsetenv("WATCHDOG_PID");
  ::setenv("WATCHDOG_USEC", "soon", 1);
  EXPECT_EQ(service_environment().watchdog, std::nullopt);
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("NOTIFY_SOCKET");
  EXPECT_EQ(service_environment().socket, "");
}

}  // namespace
}  // namespace lodestar
