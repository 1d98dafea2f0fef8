#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "app/common/background_writer.hpp"
#include "drivers/can/can_bus.hpp"
#include "drivers/can/candump.hpp"

namespace lodestar {

struct CanLogOptions {
  std::string interface = "can0";  ///< as the log names it
  /// Frames that may wait for a slow disk, 40 bytes each: 2 minutes of a base that sends 500 a second, 8 s of
  /// a bus of 1 Mbit/s that is full. Those beyond it are missing; a drive that can wait does.
  std::size_t most_waiting = 65536;
  bool can_wait = false;
  /// Called once, from the log's own thread, with a message when the log is no longer complete.
  std::function<void(const std::string&)> tell;
  DiskState disk;
};

/// The CAN frames of a drive as a candump log, written during the drive, so that it survives a crash of the
/// program. A thread of its own writes it, so that a slow disk never delays wheel commands; a full or missing
/// disk ends the log, not the drive.
class CanLog {
 public:
  /// Throws InputError when the file cannot be made.
  CanLog(std::filesystem::path file, const CanLogOptions& options);

  /// Does not wait for the disk.
  void take(const StampedCanFrame& frame) { writer_.put(frame); }

  /// Waits until everything is written, and closes the log; the destructor does so too. Returns what is
  /// missing in the file and why; empty when it is complete.
  std::string finish() { return writer_.finish().loss("can.log"); }

 private:
  void check() const;

  std::filesystem::path file_;
  std::ofstream out_;
  CandumpWriter lines_;
  BackgroundWriter<StampedCanFrame> writer_;  ///< last: its thread uses the others
};

}  // namespace lodestar
