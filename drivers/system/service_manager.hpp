#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/system/file_descriptor.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What a service manager gives to the programs that it starts: sd_notify(3) and sd_watchdog_enabled(3).
struct ServiceEnvironment {
  std::string socket;  ///< NOTIFY_SOCKET: a path, or "@NAME" in the abstract namespace; empty for none
  std::optional<Duration> watchdog;  ///< WATCHDOG_USEC, where WATCHDOG_PID is this process: longest silence
};

/// Of this process. A socket or time that cannot be used counts as none.
ServiceEnvironment service_environment();

/// Tells the service manager (systemd) that the program is ready, and from then on that its control loop goes
/// on. libsystemd's sd_notify() waits while the manager does not read; this never does, for a control loop
/// calls it: what the socket does not take is tried again with the next step.
class ServiceManager {
 public:
  explicit ServiceManager(const ServiceEnvironment& environment);

  /// Call at each step of the control loop: the first one says READY=1, then WATCHDOG=1 is said four times in
  /// the longest silence allowed. Does nothing without a manager.
  void step(Stamp now);

  /// One line for people, shown by `systemctl status`. May be called from any thread.
  void tell_status(std::string_view words) const;

  /// The loop ends on purpose, and what follows may take a while.
  void stop();

 private:
  [[nodiscard]] bool send(const std::string& state) const;

  std::string address_;
  FileDescriptor socket_;
  std::optional<Duration> watchdog_period_;
  bool is_ready_ = false;  ///< has been told so
  Stamp last_sign_;
};

}  // namespace lodestar
