#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// The frames of a drive as a candump log that grows while the robot drives: what was on the bus is known
/// even when the program dies. It is written on the side, so that no disk holds the wheels' commands up; a
/// disk that is full or gone ends the log, not the drive.
class CanLog {
 public:
  /// `tell` hears once, in words for people, that the log cannot go on; from the log's own thread.
  CanLog(std::filesystem::path file, std::string interface, std::function<void(const std::string&)> tell);

  /// Writes what is left.
  ~CanLog();
  CanLog(const CanLog&) = delete;
  CanLog& operator=(const CanLog&) = delete;

  /// Takes a moment only.
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
