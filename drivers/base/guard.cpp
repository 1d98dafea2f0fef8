#include "drivers/base/guard.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <link.h>
#include <sched.h>
#include <span>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "drivers/base/guard_loop.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// Locks the code and data of this program, not of its libraries, in memory. A callback of dl_iterate_phdr.
int lock_program(dl_phdr_info* object, std::size_t /*size*/, void* /*data*/) {
  for (const ElfW(Phdr) & segment : std::span(object->dlpi_phdr, object->dlpi_phnum)) {
    if (segment.p_type != PT_LOAD) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the linker gives addresses as numbers
    (void)mlock(reinterpret_cast<const void*>(object->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  constexpr int no_further_object = 1;  // the program comes first
  return no_further_object;
}

/// Requests real-time priority and locked memory; without the permissions the guard runs as an ordinary
/// process. What it never touches of the navigator's maps and of the libraries is not brought into memory:
/// that would take hundreds of megabytes, and the time in which the navigator starts.
void request_real_time() {
  const sched_param priority{.sched_priority = 20};
  (void)sched_setscheduler(0, SCHED_FIFO, &priority);
  (void)mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT);
  (void)dl_iterate_phdr(lock_program, nullptr);
}

/// The guard must survive whatever ends the navigator, including Ctrl-C in their terminal.
void ignore_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP}) std::signal(signal, SIG_IGN);
}

[[noreturn]] void guard(SocketCanBus& bus, int navigator_socket, const GuardOptions& options) {
  prctl(PR_SET_NAME, "lodestar-guard");
  ignore_signals();
  request_real_time();
  GuardLoop(bus, navigator_socket, options).run();
  _exit(0);
}

}  // namespace

GuardedBus::GuardedBus(const std::string& interface, const GuardOptions& options) {
  SocketCanBus bus(interface, options.bus);
  health_ = bus.health();
  std::array<int, 2> ends{-1, -1};
  const bool paired = ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) == 0;
  guard_socket_ = FileDescriptor(ends[0]);
  FileDescriptor navigator_socket(ends[1]);
  if (paired) guard_ = ::fork();
  if (guard_ == 0) {
    guard_socket_.reset();
    guard(bus, navigator_socket.get(), options);
  }
  if (guard_ > 0) return;
  throw InputError(fmt::format("guard: could not be started ({})", std::strerror(errno)));
}

GuardedBus::~GuardedBus() {
  guard_socket_.reset();
  if (guard_ > 0) (void)::waitpid(guard_, nullptr, 0);
}

bool GuardedBus::send(const CanFrame& frame) {
  const bool can_pass = health_.state != BusState::guard_lost && health_.state != BusState::held;
  const GuardRequest request{GuardRequest::Kind::send, frame};
  return can_pass && ::send(guard_socket_.get(), &request, sizeof(request), MSG_DONTWAIT | MSG_NOSIGNAL) > 0;
}

std::optional<StampedCanFrame> GuardedBus::poll() {
  while (health_.state != BusState::guard_lost) {
    GuardReport report;
    const ssize_t size = ::recv(guard_socket_.get(), &report, sizeof(report), MSG_DONTWAIT);
    if (size == static_cast<ssize_t>(sizeof(report))) {
      health_ = report.health;
      if (report.has_frame) return report.frame;
    } else if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
      return std::nullopt;
    } else {
      health_.state = BusState::guard_lost;
    }
  }
  return std::nullopt;
}

void GuardedBus::resume() {
  const GuardRequest request{GuardRequest::Kind::resume, {}};
  (void)::send(guard_socket_.get(), &request, sizeof(request), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void GuardedBus::release() {
  const GuardRequest request{GuardRequest::Kind::release, {}};
  (void)::send(guard_socket_.get(), &request, sizeof(request), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace lodestar
