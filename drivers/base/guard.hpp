#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

#include "drivers/can/can_bus.hpp"
#include "drivers/can/socketcan_bus.hpp"
#include "drivers/system/file_descriptor.hpp"

namespace lodestar {

struct GuardOptions {
  SocketCanOptions bus;
  /// The frames that stop the base; every frame with one of these identifiers is a motion command.
  std::vector<CanFrame> stop;
  Duration max_silence = std::chrono::milliseconds(100);   ///< of the navigator after a command to move
  Duration repeat_period = std::chrono::milliseconds(20);  ///< of the stop frames once the navigator failed
  int repeats = 10;
};

/// A CAN interface behind a guard: a small separate process that owns the socket and passes all frames. It
/// stops the base when the navigator dies or hangs, and then blocks commands until resume(). It does not
/// touch a base that was released. It runs with real-time priority and locked memory where permitted. If the
/// guard itself dies, nothing is sent any more and the base stops by its own timeout.
class GuardedBus final : public CanBus {
 public:
  /// Starts the guard; call it early, while the process is small and has one thread. Throws InputError as
  /// SocketCanBus does.
  GuardedBus(const std::string& interface, const GuardOptions& options);
  /// Closes the connection, upon which the guard stops the base and exits; waits for that.
  ~GuardedBus() override;

  bool send(const CanFrame& frame) override;
  std::optional<StampedCanFrame> poll() override;
  [[nodiscard]] BusHealth health() const override { return health_; }
  void resume() override;
  void release() override;

  [[nodiscard]] pid_t guard_process() const { return guard_; }

 private:
  FileDescriptor guard_socket_;
  pid_t guard_ = -1;
  BusHealth health_;
};

}  // namespace lodestar
