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
  std::vector<CanFrame>
      stop;  ///< what brings the base to rest; frames with these identifiers are its commands
  Duration max_silence = std::chrono::milliseconds(100);   ///< of a navigator that has told the base to move
  Duration repeat_period = std::chrono::milliseconds(20);  ///< of the stop, after the navigator has failed
  int repeats = 10;
};

/// A CAN interface behind a guard: a small process of its own that owns the socket, and through which all
/// frames pass. It stops the base at once when the navigator dies, and when it hangs; then it holds commands
/// back until resume(). A base that was released it leaves alone. It runs with real-time priority and locked
/// memory where that is permitted. If the guard itself dies, nothing is sent any more and the base stops by
/// its own timeout.
class GuardedBus final : public CanBus {
 public:
  /// Starts the guard; to be called early, while the process is small and has one thread. Throws InputError
  /// as SocketCanBus does.
  GuardedBus(const std::string& interface, const GuardOptions& options);
  /// The guard sees that nobody commands any more, stops the base and ends; that is waited for.
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
