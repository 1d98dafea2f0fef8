#pragma once

#include <mutex>
#include <string>
#include <thread>

#include "drivers/can/socketcan_bus.hpp"
#include "drivers/system/file_descriptor.hpp"

namespace lodestar {

/// A serial CAN adapter in software: the kernel's slcan driver at one end of a pseudo terminal, this class at
/// the other, which forwards frames from and to the base's interface. Its controller's error states are
/// simulated; the kernel's reaction is real.
class SlcanAdapter {
 public:
  explicit SlcanAdapter(const std::string& base_end);
  ~SlcanAdapter();
  SlcanAdapter(const SlcanAdapter&) = delete;
  SlcanAdapter& operator=(const SlcanAdapter&) = delete;

  /// Name of the interface that the kernel has created.
  [[nodiscard]] const std::string& interface() const { return interface_; }

  /// The controller goes bus-off: no frame passes until back_on_bus().
  void bus_off();
  void back_on_bus();

 private:
  void work();
  void handle(const std::string& line);
  void say(const std::string& line);

  FileDescriptor controller_;  ///< our end
  FileDescriptor terminal_;    ///< the kernel's end
  std::string interface_;
  SocketCanBus base_;
  std::mutex mutex_;
  bool is_off_ = false;
  std::string text_;
  std::jthread thread_;
};

}  // namespace lodestar
