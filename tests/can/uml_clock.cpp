// Preloaded into User-Mode Linux: replaces its clock and timer. Without this, its clocks run on while the
// host does other work, and deadlines of milliseconds in it are missed for no fault of its programs. With
// this, its time passes only while it runs (machine_clock.hpp). The kernel reads the time by clock_gettime,
// takes interrupts from one POSIX timer and SIGALRM, and waits for them by sigsuspend
// (arch/um/os-Linux/time.c).
#include <cerrno>
#include <csignal>
#include <ctime>
#include <dlfcn.h>
#include <unistd.h>

#include "tests/can/machine_clock.hpp"

namespace lodestar {
namespace {

/// Looked up before main: User-Mode Linux calls from stacks too small for the dynamic linker.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
auto* const next_clock_gettime = next<decltype(clock_gettime)>("clock_gettime");
auto* const next_timer_create = next<decltype(timer_create)>("timer_create");
auto* const next_timer_settime = next<decltype(timer_settime)>("timer_settime");
auto* const next_sigaction = next<decltype(sigaction)>("sigaction");
auto* const next_sigsuspend = next<decltype(sigsuspend)>("sigsuspend");

constexpr Nanoseconds second = 1'000'000'000;

Nanoseconds nanoseconds(const timespec& time) {
  return time.tv_sec * second + time.tv_nsec;
}

timespec to_timespec(Nanoseconds time) {
  return {.tv_sec = time / second, .tv_nsec = time % second};
}

Nanoseconds host_clock(clockid_t id) {
  timespec time{};
  next_clock_gettime(id, &time);
  return nanoseconds(time);
}

Nanoseconds host_now() {
  return host_clock(CLOCK_MONOTONIC);
}

const Nanoseconds monotonic_to_real = host_clock(CLOCK_REALTIME) - host_now();
MachineClock machine_clock(host_now());
timer_t host_timer{};
struct sigaction interrupt_handler{};
volatile sig_atomic_t is_setting = 0;  ///< set while the clock is being updated

class Setting {
 public:
  Setting() { is_setting = 1; }
  ~Setting() { is_setting = 0; }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;
};

void wake_in(std::optional<Nanoseconds> host_time) {
  const itimerspec once{.it_interval = {}, .it_value = to_timespec(host_time.value_or(0))};
  next_timer_settime(host_timer, 0, &once, nullptr);
}

/// The host's timer has expired, perhaps early: host time that the machine did not get does not count.
void on_alarm(int signal, siginfo_t* info, void* context) {
  constexpr Nanoseconds soon = 20'000;
  const int errno_before = errno;
  bool is_interrupt = false;
  if (is_setting != 0) {
    wake_in(soon);
  } else {
    machine_clock.look(host_now());
    is_interrupt = machine_clock.take_interrupt();
    wake_in(machine_clock.host_time_until_due());
  }
  errno = errno_before;
  if (is_interrupt) interrupt_handler.sa_sigaction(signal, info, context);
}

}  // namespace
}  // namespace lodestar

extern "C" {

int clock_gettime(clockid_t id, timespec* time) noexcept {
  using namespace lodestar;
  if (id != CLOCK_MONOTONIC && id != CLOCK_REALTIME) return next_clock_gettime(id, time);
  const Setting setting;
  const Nanoseconds now = machine_clock.look(host_now());
  *time = to_timespec(id == CLOCK_REALTIME ? now + monotonic_to_real : now);
  return 0;
}

int timer_create(clockid_t id, sigevent* event, timer_t* timer) noexcept {
  const int result = lodestar::next_timer_create(id, event, timer);
  if (result == 0) lodestar::host_timer = *timer;
  return result;
}

int timer_settime(timer_t /*timer*/, int /*flags*/, const itimerspec* in, itimerspec* /*before*/) noexcept {
  using namespace lodestar;
  const Setting setting;
  machine_clock.look(host_now());
  if (const Nanoseconds first = nanoseconds(in->it_value); first > 0) {
    machine_clock.arm(first, nanoseconds(in->it_interval));
  } else {
    machine_clock.disarm();
  }
  wake_in(machine_clock.host_time_until_due());
  return 0;
}

int timer_gettime(timer_t /*timer*/, itimerspec* out) noexcept {
  using namespace lodestar;
  const Setting setting;
  *out = {.it_interval = {}, .it_value = to_timespec(machine_clock.until_due().value_or(0))};
  return 0;
}

int sigaction(int signal, const struct sigaction* in, struct sigaction* before) noexcept {
  using namespace lodestar;
  if (signal != SIGALRM || in == nullptr || (in->sa_flags & SA_SIGINFO) == 0) {
    return next_sigaction(signal, in, before);
  }
  interrupt_handler = *in;
  struct sigaction ours = *in;
  ours.sa_sigaction = on_alarm;
  return next_sigaction(signal, &ours, before);
}

/// Idle, with SIGALRM blocked, until an interrupt.
int sigsuspend(const sigset_t* mask) {
  using namespace lodestar;
  {
    const Setting setting;
    machine_clock.leap_to_due();
  }
  kill(getpid(), SIGALRM);
  return next_sigsuspend(mask);
}
}
