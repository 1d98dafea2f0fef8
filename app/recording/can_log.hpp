#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// The CAN frames of a drive as a candump log, written during the drive, so that it survives a crash of the
/// program. A thread of its own writes it, so that a slow disk never delays wheel commands; a full or missing
/// disk ends the log, not the drive.
class CanLog {
 public:
  /// `tell` is called once, from the log's own thread, when the log cannot be written any more.
  CanLog(std::filesystem::path file, std::string interface, std::function<void(const std::string&)> tell);

  /// Writes what is left.
  ~CanLog();
  CanLog(const CanLog&) = delete;
  CanLog& operator=(const CanLog&) = delete;

  /// Does not wait for the disk.
  void take(const StampedCanFrame& frame);

 private:
  void work(const std::stop_token& stop);
  std::vector<StampedCanFrame> taken();

  std::filesystem::path file_;
  std::string interface_;
  std::function<void(const std::string&)> tell_;
  std::mutex mutex_;
  std::vector<StampedCanFrame> frames_;  ///< taken, not yet written
  bool ended_ = false;
  std::jthread thread_;
};

}  // namespace lodestar
