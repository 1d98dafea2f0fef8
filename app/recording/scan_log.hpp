#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "app/common/background_writer.hpp"
#include "app/navigation/navigation.hpp"
#include "app/recording/scan_file.hpp"

namespace lodestar {

struct ScanLogOptions {
  /// Beams that may wait for a slow disk, 40 bytes each: 40 s of a scanner that measures 7200 a second.
  std::size_t most_waiting = 300'000;
  bool can_wait = false;
  /// Called once, from the log's own thread, with a message when the log is no longer complete.
  std::function<void(const std::string&)> tell;
  DiskState disk;
};

/// scans.bin: every scan of a drive to the bit, written while the robot drives, so that it survives a crash
/// of the program. 720 beams ten times a second make 12.5 MB a minute. A thread of its own writes it, so that
/// a slow disk never delays wheel commands; a full or missing disk ends the log, not the drive.
class ScanLog {
 public:
  /// Throws InputError when the file cannot be made.
  ScanLog(const std::filesystem::path& folder, const ScannerMount& mount, const ScanLogOptions& options);

  /// Does not wait, but where the drive can.
  void take(const SensorInput& input);

  /// Waits until everything is written. Returns what is missing and why; empty when nothing is.
  std::string finish() { return writer_.finish().loss("scans.bin"); }

 private:
  void check() const;

  std::filesystem::path file_;
  std::ofstream out_;
  BackgroundWriter<LoggedScan> writer_;  ///< last: its thread uses the others
};

}  // namespace lodestar
