// CPU load of viewers on the robot: a simulated robot drives in real time, first without viewers, then with
// many clients that read everything, pictures too, and one that never reads.
//
//     build/release/viewers_load [VIEWERS [SECONDS]]        100 viewers, 12 s with them and 12 s without

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fmt/core.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "app/commands/console_service.hpp"
#include "app/live/operator_session.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "drivers/system/clock.hpp"
#include "maps/percentile.hpp"

#include "tests/app/net/socket_client.hpp"

namespace lodestar {
namespace {

double cpu_s(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The viewers, in a process of their own, so that their work is not measured.
int watch(unsigned short port, int viewers, int seconds) {
  std::atomic<long> messages = 0;
  const Stamp end = monotonic_now() + std::chrono::seconds(seconds);
  std::vector<std::thread> threads;
  for (int i = 0; i < viewers; ++i) {
    threads.emplace_back([&, i] {
      SocketClient client(port);
      (void)client.upgrade("lodestar.v1");
      if (i < 3) client.send(R"({"type": "camera", "on": true})");  // pictures for three viewers
      while (monotonic_now() < end && client.receive()) ++messages;
    });
  }
  SocketClient sleeper(port);
  (void)sleeper.upgrade("lodestar.v1");
  sleeper.send(R"({"type": "camera", "on": true})");
  for (std::thread& thread : threads) thread.join();
  fmt::print("{} viewers got {:.0f} messages a second, {:.1f} each\n", viewers,
             static_cast<double>(messages) / seconds, static_cast<double>(messages) / seconds / viewers);
  return 0;
}

/// One part of the drive, as the control loop saw it.
class Part {
 public:
  void begin() {
    thread_s_ = cpu_s(CLOCK_THREAD_CPUTIME_ID);
    process_s_ = cpu_s(CLOCK_PROCESS_CPUTIME_ID);
    begun_ = last_ = monotonic_now();
  }
  void step() {
    const Stamp now = monotonic_now();
    periods_ms_.push_back(1e3 * seconds(now - last_));
    last_ = now;
  }
  void end() {
    wall_s_ = seconds(monotonic_now() - begun_);
    thread_s_ = cpu_s(CLOCK_THREAD_CPUTIME_ID) - thread_s_;
    process_s_ = cpu_s(CLOCK_PROCESS_CPUTIME_ID) - process_s_;
  }
  [[nodiscard]] double thread_share() const { return thread_s_ / wall_s_; }
  void tell(const char* name) const {
    const auto period = [&](double share) { return percentile(periods_ms_, share).value_or(0.0); };
    fmt::print(
        "{:<15} control loop {:5.2f} % of a core, all threads {:5.2f} %; period (ms) p50 {:.2f} p99 {:.2f} "
        "p99.9 {:.2f} max {:.2f}\n",
        name, 100.0 * thread_s_ / wall_s_, 100.0 * process_s_ / wall_s_, period(0.5), period(0.99),
        period(0.999), period(1.0));
  }

 private:
  double thread_s_ = 0.0;
  double process_s_ = 0.0;
  double wall_s_ = 0.0;
  Stamp begun_;
  Stamp last_;
  std::vector<double> periods_ms_;
};

int measure(int viewers, int seconds_each) {
  const Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  int port_pipe[2];
  if (pipe(port_pipe) != 0) return 1;
  const pid_t child = fork();
  if (child == 0) {
    unsigned short port = 0;
    if (read(port_pipe[0], &port, sizeof port) != sizeof port) _exit(1);
    const int code = watch(port, viewers, seconds_each);
    std::fflush(stdout);
    _exit(code);
  }

  LiveLink link;
  ConsoleServiceOptions console;
  console.site = site.folder;
  ConsoleService service(console, &link);
  const ConsoleThread thread(service);
  OperatorSession session(link);
  Part unseen;
  Part watched;
  const long steps_each = 50L * seconds_each;
  long steps = 0;
  const auto goes_on = [&] {
    if (steps == 0) unseen.begin();
    if (steps > 0) (steps <= steps_each ? unseen : watched).step();
    if (steps == steps_each) {
      unseen.end();
      const unsigned short port = service.port();
      if (write(port_pipe[1], &port, sizeof port) != sizeof port) return false;
      watched.begin();
    }
    return ++steps <= 2 * steps_each;
  };
  simulate_attended_drive(site, {.camera = site.default_camera, .goals = site.goals, .realtime = true},
                          session, goes_on, [](const RunRecord&) {});
  watched.end();
  waitpid(child, nullptr, 0);
  unseen.tell("unseen:");
  watched.tell("with viewers:");
  fmt::print("the viewers cost the control loop {:.2f} % of a core\n",
             100.0 * (watched.thread_share() - unseen.thread_share()));
  return 0;
}

int bounded(const char* text, int most) {
  return std::clamp(std::atoi(text), 1, most);
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  const int viewers = argc > 1 ? lodestar::bounded(argv[1], 120) : 100;
  const int seconds = argc > 2 ? lodestar::bounded(argv[2], 40) : 12;
  return lodestar::measure(viewers, seconds);
}
